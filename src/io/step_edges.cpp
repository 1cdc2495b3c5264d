// Vertices and edges. An edge of the model runs along its curve with growing parameter; an EDGE_CURVE that
// runs against its curve becomes an edge that its uses run through backwards.
//
// The parameters of the ends. The file gives the end points and the curve; the parameters are those of the
// nearest points of the curve: the ends of a spline, if they are as near as the file promises.
#include "step_shape.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

// Edges shorter than this, of the tolerance, are none: they run to and fro within the errors of their ends.
constexpr double kTiny = 1e-3;
// A spline around one vertex that misses closing by less, of its length, is meant to close.
constexpr double kNearlyClosed = 0.01;
// Of the tolerance: an open curve between a vertex and itself that is longer is no point.
constexpr double kPoint = 16;
// Parameters beyond this have lost digits of an angle.
constexpr double kFarAround = 100;

// Of chords: not above the length of the curve. Once it is above `most`, how long it is no longer matters.
double chord_length(const CurveGeometry<3>& c, Interval on, double most = kInfinity) {
    constexpr int kChords = 8;
    double length = 0;
    Vec<3> last = jet<0>(c, on.lo).value();
    for (int i = 1; i <= kChords && length <= most; ++i) {
        const Vec<3> p = jet<0>(c, on.lo + on.length() * i / kChords).value();
        length += norm(p - last), last = p;
    }
    return length;
}

}  // namespace

int ShapeReader::vertex_at(std::uint32_t point, const Vec<3>& p) {
    const auto [at, fresh] = points_.emplace(point, int(out_.model.vertices.size()));
    if (fresh) {
        vertex_of_.emplace(at->second, point);
        out_.model.vertices.push_back({p, 0});
    }
    return at->second;
}

Result<int> ShapeReader::vertex(std::uint32_t i) {
    if (const auto known = vertices_.find(i); known != vertices_.end()) return known->second;
    const auto f = Fields::of(f_, i, Type::VERTEX_POINT, 1);
    if (!f) return std::unexpected(f.error());
    const auto at = f->reference(f->size() - 1, "point");
    if (!at) return std::unexpected(at.error());
    const auto p = geometry_.point(*at);
    if (!p) return std::unexpected(p.error());
    const int v = int(out_.model.vertices.size());
    out_.model.vertices.push_back({*p, 0});
    vertices_.emplace(i, v);
    vertex_of_.emplace(v, i);
    return v;
}

// Between vertices of a POLY_LOOP.
Result<ShapeReader::EdgeMade> ShapeReader::straight_edge(int from, int to) {
    const bool flipped = from > to;
    if (flipped) std::swap(from, to);
    const auto key = (std::uint64_t(std::uint32_t(from)) << 32) | std::uint32_t(to);
    const auto known = straight_.find(key);
    if (known != straight_.end()) return EdgeMade{known->second.edge, flipped, known->second.empty};
    const Vec<3> a = out_.model.vertices[std::size_t(from)].point,
                 b = out_.model.vertices[std::size_t(to)].point;
    EdgeMade made;
    const double length = norm(b - a);
    made.empty = !(length > 0);
    if (!made.empty) {
        Edge e;
        e.curve = Line<3>{a, (1 / length) * (b - a)};
        e.range = {0, length};
        e.start = from, e.end = to, e.tolerance = tolerance_;
        made.edge = int(out_.model.edges.size());
        out_.model.edges.push_back(std::move(e));
    }
    straight_.emplace(key, made);
    made.flipped = flipped;
    return made;
}

bool ShapeReader::is_tiny(const CurveGeometry<3>& c, Interval on) const {
    return chord_length(c, on, kTiny * tolerance_) <= kTiny * tolerance_;
}

Result<std::span<const ShapeReader::EdgeMade>> ShapeReader::edge(std::uint32_t i) {
    auto known = edges_.find(i);
    const bool fresh = known == edges_.end();
    if (fresh) known = edges_.emplace(i, make_edge(i)).first;
    if (!known->second) return std::unexpected(known->second.error());
    const auto row = rows_.find(i);
    const std::span<const EdgeMade> made =
        row != rows_.end() ? std::span<const EdgeMade>(row->second) : std::span(&*known->second, 1);
    if (fresh)
        for (const EdgeMade& m : made)
            if (m.edge >= 0) style_edge(out_.model.edges[std::size_t(m.edge)], i);
    return made;
}

// As the item is styled, where the edge has no colour yet.
void ShapeReader::style_edge(Edge& e, std::uint32_t item) const {
    if (const auto c = styles_.curve_colours.find(item); c != styles_.curve_colours.end() && !e.colour)
        e.colour = c->second;
    styles_.add_layers(e.layers, item);
}

void ShapeReader::tell_ends(std::uint32_t edge, const std::array<int, 2>& vertices, double off) {
    if (!(off > tolerance_)) return;
    report(int(out_.model.edges.size()),
           text(f_.label(edge), " ends ", off, " from its vertex; the file says at most ", tolerance_),
           std::nullopt, off);
    for (const int v : vertices) {
        Vertex& x = out_.model.vertices[std::size_t(v)];
        x.tolerance = std::max(x.tolerance, off);
    }
}

// What a SUBEDGE or SUBFACE is a part of, through parts of parts; the item itself if it is no part.
Result<std::uint32_t> ShapeReader::whole_of(std::uint32_t i, Type part, int parent) const {
    constexpr int kDeepest = 64;
    std::uint32_t whole = i;
    for (int steps = 0; f_.is(whole, part); ++steps) {
        const Fields f(f_, whole, f_.part(whole, part));
        if (steps == kDeepest)
            return refuse(
                RefusalKind::invalid, f_.label(i),
                text("is a part of a part of a part, more than ", kDeepest, " times, or of itself"));
        const auto of = f.reference(parent, "what it is a part of");
        if (!of) return std::unexpected(of.error());
        whole = *of;
    }
    return whole;
}

Result<ShapeReader::EdgeMade> ShapeReader::make_edge(std::uint32_t i) {
    const auto whole_edge = whole_of(i, Type::SUBEDGE, 3);
    if (!whole_edge) return std::unexpected(whole_edge.error());
    const bool is_part = *whole_edge != i;
    const auto f = Fields::of(f_, i, is_part ? Type::SUBEDGE : Type::EDGE_CURVE, is_part ? 4 : 5);
    if (!f) return std::unexpected(f.error());
    const auto of = Fields::of(f_, *whole_edge, Type::EDGE_CURVE, 5);
    if (!of) return std::unexpected(of.error());
    std::array<int, 2> end{};
    for (int k = 0; k < 2; ++k) {
        const auto at = f->reference(1 + k, "vertex");
        if (!at) return std::unexpected(at.error());
        const auto v = vertex(*at);
        if (!v) return std::unexpected(v.error());
        end[std::size_t(k)] = *v;
    }
    const auto at = of->reference(3, "curve");
    if (!at) return std::unexpected(at.error());
    if (const std::uint32_t composite = composite_in(f_, *at); composite != kMissing) {
        auto row = composite_edge(*f, i, of->flag(4), composite, end);
        if (!row) return std::unexpected(row.error());
        rows_.emplace(i, std::move(*row));
        return EdgeMade{};
    }
    const std::array<Vec<3>, 2> ends{out_.model.vertices[std::size_t(end[0])].point,
                                     out_.model.vertices[std::size_t(end[1])].point};
    const auto c = curve_in_space(*at, &ends);
    if (!c) return std::unexpected(c.error());
    EdgeMade made;
    made.curve = *at;
    made.flipped = of->flag(4) == c->reversed;
    if (made.flipped) std::swap(end[0], end[1]);
    const Vec<3> a = out_.model.vertices[std::size_t(end[0])].point,
                 b = out_.model.vertices[std::size_t(end[1])].point;
    const Interval whole = domain(c->curve)[0];
    const auto* conic = std::get_if<Conic<3>>(&c->curve);
    const bool periodic = conic != nullptr && conic->kind == ConicKind::ellipse,
               line = std::holds_alternative<Line<3>>(c->curve);
    const bool spline = conic == nullptr && !line;
    double off_a = 0, off_b = 0, lo = 0, hi = 0;
    const auto at_end = [&](double t, const Vec<3>& p) { return norm(jet<0>(c->curve, t).value() - p); };
    const Interval part = c->range.value_or(Interval{});
    if (part.lo < part.hi && std::abs(part.lo) < kFarAround && at_end(part.lo, a) <= tolerance_ &&
        at_end(part.hi, b) <= tolerance_) {
        // Trimmed, where its vertices are: where the curve meets itself, they say less.
        lo = part.lo, hi = part.hi;
        off_a = at_end(lo, a), off_b = at_end(hi, b);
    } else if (spline && at_end(whole.lo, a) <= tolerance_ && at_end(whole.hi, b) <= tolerance_) {
        lo = whole.lo, hi = whole.hi;
        off_a = at_end(lo, a), off_b = at_end(hi, b);
    } else {
        lo = parameter_of(c->curve, a, off_a), hi = parameter_of(c->curve, b, off_b);
        if (spline) {
            const bool closes =
                norm(jet<0>(c->curve, whole.lo).value() - jet<0>(c->curve, whole.hi).value()) <= tolerance_;
            // Where it closes, its ends are one point: as near to a vertex as what is nearest.
            if (closes && at_end(whole.lo, a) <= off_a + tolerance_) lo = whole.lo;
            if (closes && at_end(whole.hi, b) <= off_b + tolerance_) hi = whole.hi;
            if (!closes && end[0] != end[1] && lo > hi) {
                // One that nearly closes has a vertex beside both its ends, and the sense of the edge says
                // which.
                const double far_a = at_end(whole.lo, a), far_b = at_end(whole.hi, b);
                if (std::min(far_a, far_b) <= kNearlyClosed * chord_length(c->curve, whole)) {
                    if (far_b <= far_a)
                        hi = whole.hi, off_b = far_b;
                    else
                        lo = whole.lo, off_a = far_a;
                }
            }
            if (!closes && end[0] == end[1] && !(lo < hi)) {
                const double length = chord_length(c->curve, whole);
                const double off = std::max(at_end(whole.lo, a), at_end(whole.hi, a));
                if (off <= kNearlyClosed * length)
                    lo = whole.lo, hi = whole.hi, off_a = off_b = off;
                else if (length > tolerance_ && length <= kPoint * tolerance_) {
                    report(-1, text(f_.label(i), " begins and ends at one vertex, and is taken for that"),
                           std::nullopt, off);
                    made.empty = true;
                    return made;
                } else if (length > tolerance_)
                    return f->refused(
                        text("begins and ends at one vertex, but its curve is ",
                             norm(jet<0>(c->curve, whole.lo).value() - jet<0>(c->curve, whole.hi).value()),
                             " from closing"),
                        RefusalKind::invalid);
            }
            if (closes && !(lo < hi)) {
                // Over the end of the curve: one spline from there on.
                if (auto longer = continued(c->curve, hi + whole.length(), tolerance_)) {
                    hi += whole.length();
                    Edge e;
                    e.curve = std::move(*longer);
                    e.range = {lo, hi};
                    e.start = end[0], e.end = end[1], e.tolerance = std::max({tolerance_, off_a, off_b});
                    e.name = name_in(*f);
                    made.edge = int(out_.model.edges.size());
                    out_.model.edges.push_back(std::move(e));
                    return made;
                }
            }
        }
        if (periodic) {
            lo -= std::floor(lo / kTwoPi + 1e-12) * kTwoPi;
            if (std::abs(lo) < 1e-15) lo = 0;
            hi = lo + (hi - lo) - std::floor((hi - lo) / kTwoPi) * kTwoPi;
            const double radius = std::max(norm(conic->x), norm(conic->y));
            if (end[0] == end[1] || hi - lo <= 1e-12 || (hi - lo) * radius <= 1e-3 * tolerance_)
                hi = lo + kTwoPi;
        }
    }
    if (!(lo < hi) || (!periodic && end[0] == end[1] &&
                       norm(jet<0>(c->curve, lo + (hi - lo) / 2).value() - a) <= tolerance_)) {
        if (norm(a - b) <= tolerance_) {
            made.empty = true;
            return made;
        }
        // A spline that is given backwards, or a sense that is wrong.
        if (lo > hi && !periodic && f_.is(*at, Type::TRIMMED_CURVE) == false && lo - hi > 0) {
            std::swap(lo, hi);
            std::swap(end[0], end[1]);
            made.flipped = !made.flipped;
            report(int(out_.model.edges.size()),
                   text(f_.label(i),
                        " runs against its curve, though it says that it does not; it is taken as it runs"),
                   0.0, 0);
        } else {
            return f->refused(text("runs over the empty range [", lo, ", ", hi, "] of its curve"),
                              RefusalKind::invalid);
        }
    }
    if (end[0] != end[1] && is_tiny(c->curve, {lo, hi})) {
        // That no part of a curved one is further off is seen at some points only.
        const bool straight = std::holds_alternative<Line<3>>(c->curve);
        report(-1, text(f_.label(i), " is shorter than a thousandth of the tolerance; its vertices are one"),
               straight ? std::optional<double>(norm(a - b) * (1 + 8 * kUnitRoundoff)) : std::nullopt,
               kTiny * tolerance_);
        // What was told of it is told of no edge.
        for (int& e : out_.approximated) e = e < int(out_.model.edges.size()) ? e : -1;
        join_vertices(end[0], end[1]);
        made.empty = true;
        return made;
    }
    Edge e;
    e.curve = c->curve;
    e.range = {lo, hi};
    e.start = end[0], e.end = end[1];
    e.tolerance = tolerance_;
    e.name = name_in(*f);
    tell_ends(i, end, std::max(off_a, off_b));
    made.edge = int(out_.model.edges.size());
    out_.model.edges.push_back(std::move(e));
    return made;
}

}  // namespace freiform::step
