// Composite curves (COMPOSITE_CURVE, COMPOSITE_CURVE_ON_SURFACE, and what wraps them) as edges: one for each
// segment, so that lines stay lines, circles circles, and corners vertices. Nothing is approximated.
//
// Method. The segments, also those of composite curves among them, are laid out in one row. One that runs
// against its neighbour is turned, which is told. The vertices of an EDGE_CURVE cut the row where they lie on
// it; a row that closes may begin anywhere.
//
// Gaps. Segments that end beside each other within the tolerance share a vertex, which has the gap as its
// tolerance. A wider gap makes the edge none: it is refused, or closed by a straight edge if repairs are
// asked for. Wires keep what there is, and tell.
//
// Cost. Every segment pays, with its control points, out of what the text has room for: composite curves that
// contain themselves, or each other many times, end there.
//
// Why not one spline for all segments? A circle would become a rational spline with another parameter, and
// parameter curves that follow an edge have no corners.
//
// References: ISO 10303-42:2014, 4.4 (composite_curve, composite_curve_segment).
#include "step_shape.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

std::size_t control_points(const CurveGeometry<3>& c) {
    return visit_one(
        [](const auto& g) -> std::size_t {
            if constexpr (requires { g.net(); })
                return g.net().flat().size();
            else
                return 0;
        },
        c);
}

}  // namespace

Vec<3> ShapeReader::Segment::end(bool last) const {
    return jet<0>(shape, last != backward ? on.hi : on.lo).value();
}

Result<std::vector<ShapeReader::Segment>> ShapeReader::segments_of(std::uint32_t composite) {
    struct Piece {
        std::uint32_t segment, curve;
        bool forward;
    };
    const auto pay = [&](std::size_t n) {
        const bool enough = n <= segments_left_;
        segments_left_ = enough ? segments_left_ - n : 0;
        return enough;
    };
    const auto too_many = [&] {
        return refuse(RefusalKind::limit, f_.label(composite),
                      "contains itself, or has more segments than the file");
    };
    std::vector<Piece> todo{{composite, composite, true}};
    std::vector<Segment> out;
    while (!todo.empty()) {
        const Piece p = todo.back();
        todo.pop_back();
        if (const std::uint32_t inner = composite_in(f_, p.curve); inner != kMissing) {
            auto parts = segments_in(f_, inner);
            if (!parts) return std::unexpected(parts.error());
            if (!pay(parts->size() + 1)) return too_many();
            if (p.forward) std::ranges::reverse(*parts);  // the last one is taken first
            for (const CompositeSegment& s : *parts)
                todo.push_back({s.instance, s.curve, s.forward == p.forward});
            continue;
        }
        auto c = curve_in_space(p.curve, nullptr);
        if (!c)
            return refuse(c.error().kind, f_.label(p.segment),
                          text(c.error().where, ": ", c.error().message));
        const Interval on = c->range.value_or(domain(c->curve)[0]);
        if (!std::isfinite(on.length()) || !(on.lo < on.hi))
            return refuse(RefusalKind::invalid, f_.label(p.segment), "is a part of a curve without end");
        if (!pay(1 + control_points(c->curve))) return too_many();
        out.push_back({p.segment, p.curve, std::move(c->curve), on, c->reversed == p.forward});
    }
    if (out.empty()) return refuse(RefusalKind::invalid, f_.label(composite), "has no segments");
    return out;
}

double ShapeReader::row_size(const std::vector<Segment>& row) {
    Box<3> box;
    for (const Segment& s : row)
        for (int k = 0; k <= 4; ++k) box.add(jet<0>(s.shape, s.on.lo + s.on.length() * k / 4).value());
    return box.diagonal();
}

// Segments that run against their neighbours are turned; which ones.
std::vector<std::uint32_t> ShapeReader::turn_segments(std::vector<Segment>& row, double joint) {
    std::vector<std::uint32_t> turned;
    for (std::size_t k = 0; row.size() > 1 && k < row.size(); ++k) {
        Segment& s = row[k];
        // The first one has to meet the second, however that one runs.
        const auto meets = [&](bool last) {
            const Vec<3> p = s.end(last);
            if (k > 0) return norm(p - row[k - 1].end(true)) <= joint;
            return std::min(norm(p - row[1].end(false)), norm(p - row[1].end(true))) <= joint;
        };
        if (meets(k == 0) || !meets(k != 0)) continue;
        s.backward = !s.backward;
        turned.push_back(s.instance);
    }
    return turned;
}

// Where the point lies on the row: the number of the segment that begins there, if need be as the second part
// of one that is cut. `off`: its distance.
std::size_t ShapeReader::cut_at(std::vector<Segment>& row, const Vec<3>& p, double joint, double& off) {
    std::size_t at = 0;
    off = norm(row[0].end(false) - p);
    for (std::size_t k = 0; k < row.size(); ++k)
        if (const double d = norm(row[k].end(true) - p); d < off) off = d, at = k + 1;
    if (off <= joint) return at;
    double where = 0;
    bool inside = false;
    for (std::size_t k = 0; k < row.size(); ++k) {
        double d = 0, t = parameter_of(row[k].shape, p, d);
        const auto* c = std::get_if<Conic<3>>(&row[k].shape);
        if (c != nullptr && c->kind == ConicKind::ellipse)
            t -= std::floor((t - row[k].on.lo) / kTwoPi) * kTwoPi;
        if (d < off && row[k].on.lo < t && t < row[k].on.hi) off = d, at = k, where = t, inside = true;
    }
    if (!inside) return at;
    Segment second = row[at];
    (second.backward ? second.on.hi : second.on.lo) = where;
    (second.backward ? row[at].on.lo : row[at].on.hi) = where;
    row.insert(row.begin() + std::ptrdiff_t(at) + 1, std::move(second));
    return at + 1;
}

// Edges of the row, from one vertex to another; segments of no length are left out.
std::vector<ShapeReader::EdgeMade> ShapeReader::row_edges(std::vector<Segment> row, std::array<int, 2> ends,
                                                          const std::string& name) {
    std::erase_if(row, [&](const Segment& s) { return is_tiny(s.shape, s.on); });
    std::vector<EdgeMade> made;
    if (row.empty()) {
        join_vertices(ends[0], ends[1]);
        for (int& e : out_.approximated) e = e < int(out_.model.edges.size()) ? e : -1;
        return {EdgeMade{-1, false, true, kMissing}};
    }
    int from = ends[0];
    for (std::size_t k = 0; k < row.size(); ++k) {
        int to = ends[1];
        if (k + 1 < row.size()) {
            const Vec<3> p = row[k + 1].end(false);
            to = int(out_.model.vertices.size());
            out_.model.vertices.push_back({p, norm(row[k].end(true) - p)});
            vertex_of_.emplace(to, row[k + 1].instance);
        }
        Edge e;
        e.curve = std::move(row[k].shape);
        e.range = row[k].on;
        e.start = from, e.end = to;
        if (row[k].backward) std::swap(e.start, e.end);
        e.tolerance = tolerance_;
        e.name = name;
        made.push_back({int(out_.model.edges.size()), row[k].backward, false, row[k].curve});
        out_.model.edges.push_back(std::move(e));
        from = to;
    }
    return made;
}

// Gaps wider than `joint` are refused, or, if that is asked for and they are within `limit`, closed.
Result<void> ShapeReader::close_gaps(std::vector<Segment>& row, double joint, double limit) {
    std::vector<Segment> closed;
    const std::size_t repairs = out_.model.repairs.size();
    for (Segment& s : row) {
        const Vec<3> q = s.end(false), p = closed.empty() ? q : closed.back().end(true);
        const double gap = norm(q - p);
        if (!(gap <= joint)) {
            if (!options_.repair || !(gap <= limit)) {
                out_.model.repairs.resize(repairs);
                return refuse(
                    RefusalKind::invalid, f_.label(s.instance),
                    text("begins ", gap, " from where the segment before it ends; the file says at most ",
                         tolerance_,
                         gap <= limit ? "; a repair (--repair) closes it with a straight edge" : ""));
            }
            repaired(s.instance,
                     "begins beside the end of the segment before it; a straight edge closes that", gap);
            closed.push_back({s.instance, kMissing, Line<3>{p, (1 / gap) * (q - p)}, {0, gap}, false});
        }
        closed.push_back(std::move(s));
    }
    row = std::move(closed);
    return {};
}

Result<std::vector<ShapeReader::EdgeMade>> ShapeReader::composite_edge(const Fields& f, std::uint32_t i,
                                                                       bool forward, std::uint32_t composite,
                                                                       const std::array<int, 2>& vertices) {
    auto row = segments_of(composite);
    if (!row) return std::unexpected(row.error());
    const double size = row_size(*row), joint = std::max(tolerance_, kNearEnds * size);
    const auto turned = turn_segments(*row, joint);
    const auto turn_around = [&] {
        std::ranges::reverse(*row);
        for (Segment& s : *row) s.backward = !s.backward;
    };
    const auto between = [](const Vec<3>& p, const Vec<3>& q) { return norm(p - q); };
    const std::array<Vec<3>, 2> at{out_.model.vertices[std::size_t(vertices[0])].point,
                                   out_.model.vertices[std::size_t(vertices[1])].point};
    if (!forward) turn_around();
    const std::size_t repairs = out_.model.repairs.size();
    if (auto ok = close_gaps(*row, joint, repair_limit(size)); !ok) return std::unexpected(ok.error());
    const auto meets = [&](bool last, int vertex) {
        return between(last ? row->back().end(true) : row->front().end(false), at[std::size_t(vertex)]) <=
               joint;
    };
    const bool closed = between(row->front().end(false), row->back().end(true)) <= joint;
    const bool against = !closed && meets(false, 1) && meets(true, 0) && !meets(false, 0);
    if (against) turn_around();
    std::array<double, 2> off{};
    std::size_t first = cut_at(*row, at[0], joint, off[0]);
    if (closed)
        std::rotate(row->begin(), row->begin() + std::ptrdiff_t(first), row->end());
    else
        row->erase(row->begin(), row->begin() + std::ptrdiff_t(first));
    const bool whole = closed && vertices[0] == vertices[1];
    std::size_t last = whole ? row->size() : row->empty() ? 0 : cut_at(*row, at[1], joint, off[1]);
    if (last == 0 && closed) last = row->size();
    if (last == 0) {
        out_.model.repairs.resize(repairs);
        return f.refused("runs over an empty part of its composite curve", RefusalKind::invalid);
    }
    row->erase(row->begin() + std::ptrdiff_t(last), row->end());
    const auto tell = [&](std::string what, double estimate) {
        report(int(out_.model.edges.size()), std::move(what),
               estimate > 0 ? std::nullopt : std::optional<double>(0.0), estimate);
    };
    for (const std::uint32_t id : turned)
        tell(text(f_.label(id), " runs against its composite curve; it is taken the other way"), 0);
    if (against)
        tell(text(f_.label(i),
                  " runs against its curve, though it says that it does not; it is taken as it runs"),
             0);
    for (std::size_t k = 1; k < row->size(); ++k)
        if (const double gap = between((*row)[k - 1].end(true), (*row)[k].end(false)); gap > tolerance_)
            tell(text(f_.label((*row)[k].instance), " begins ", gap,
                      " from where the segment before it ends; the file says at most ", tolerance_),
                 gap);
    tell_ends(i, vertices, std::max(off[0], off[1]));
    return row_edges(std::move(*row), vertices, name_in(f));
}

// A composite curve that no edge has: its own vertices, and a new row behind each gap.
Result<void> ShapeReader::free_composite(std::uint32_t composite) {
    auto row = segments_of(composite);
    if (!row) return std::unexpected(row.error());
    const double joint = std::max(tolerance_, kNearEnds * row_size(*row));
    turn_segments(*row, joint);
    const auto vertex = [&](const Vec<3>& p) {
        out_.model.vertices.push_back({p, 0});
        return int(out_.model.vertices.size()) - 1;
    };
    const std::string name = name_in(Fields(f_, composite, f_.instances[composite].first + 1));
    for (std::size_t from = 0, to = 0; from < row->size(); from = to) {
        for (to = from + 1; to < row->size(); ++to) {
            const double gap = norm((*row)[to - 1].end(true) - (*row)[to].end(false));
            if (gap <= joint) continue;
            report(-1,
                   text(f_.label((*row)[to].instance), " begins ", gap,
                        " from where the segment before it ends; both are taken as they stand"),
                   0.0, 0);
            break;
        }
        std::vector<Segment> part(std::make_move_iterator(row->begin() + std::ptrdiff_t(from)),
                                  std::make_move_iterator(row->begin() + std::ptrdiff_t(to)));
        const Vec<3> a = part.front().end(false), b = part.back().end(true);
        const int first = vertex(a);
        row_edges(std::move(part), {first, norm(a - b) <= joint ? first : vertex(b)}, name);
    }
    return {};
}

}  // namespace freiform::step
