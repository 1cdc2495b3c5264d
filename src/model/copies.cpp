// Idea: an assembly has the same screw a hundred times. Readers put each where it belongs, so its numbers
// differ, but its topology and all that is said in parameters is the same. A motion follows from three points
// and their images; that it takes the one part to the other is then verified, for all control points, axes
// and centres, so that nothing needs to be known about where the copies come from. Method: parts that hang
// together are compared with earlier ones of the same counts. Accuracy: surfaces are linear in what is
// compared (the points of a revolution but for its axis), so bounds of the differences bound their distance.
// Rounding: a moved vector is off by at most 9 units u of the largest coordinate, and a revolution compares
// its axis five times over at up to three times that distance, its origin twice and a profile of three
// vectors: less than 250 u with the motion of the mesh itself; 512 u are added. Cost: linear in the size of
// the model, for each part and kPatterns others at most.
#include "copies_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace freiform {

namespace {

constexpr std::size_t kPatterns = 4;   // of equal counts that a part is compared with
constexpr double kRounding = 0x1p-44;  // of what is compared and moved, times the largest coordinates
constexpr double kAlike = 0x1p-36;     // of the largest coordinates: apart by no more
constexpr double kThin = 1e-3;         // of the largest distance: points nearer to a line tell no turn

struct Part {
    std::vector<int> faces, edges, vertices;
};

// Faces, their edges and vertices, by what they share.
std::vector<Part> parts_of(const Model& model) {
    const std::size_t nv = model.vertices.size();
    std::vector<int> same(nv);
    std::iota(same.begin(), same.end(), 0);
    const auto first_of = [&](int v) {
        while (same[std::size_t(v)] != v) v = same[std::size_t(v)] = same[std::size_t(same[std::size_t(v)])];
        return v;
    };
    const auto join = [&](int a, int b) {
        const auto [lo, hi] = std::minmax({first_of(a), first_of(b)});
        same[std::size_t(hi)] = lo;
    };
    std::vector<char> used(model.edges.size(), 0);
    std::vector<int> start(model.faces.size(), -1);
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (const Loop& l : model.faces[f].loops)
            for (const Coedge& c : l.coedges) {
                const Edge& e = model.edges[std::size_t(c.edge)];
                used[std::size_t(c.edge)] = 1;
                join(e.start, e.end);
                if (start[f] >= 0) join(start[f], e.start);
                start[f] = e.start;
            }
    std::vector<int> number(nv, -1);
    std::vector<Part> parts;
    const auto part_at = [&](int vertex) -> Part& {
        int& n = number[std::size_t(first_of(vertex))];
        if (n < 0) n = int(parts.size()), parts.emplace_back();
        return parts[std::size_t(n)];
    };
    for (std::size_t f = 0; f < start.size(); ++f)
        if (start[f] >= 0) part_at(start[f]).faces.push_back(int(f));
    std::vector<char> has(nv, 0);
    for (std::size_t e = 0; e < used.size(); ++e)
        if (used[e]) {
            part_at(model.edges[e].start).edges.push_back(int(e));
            has[std::size_t(model.edges[e].start)] = has[std::size_t(model.edges[e].end)] = 1;
        }
    for (std::size_t v = 0; v < nv; ++v)
        if (has[v]) part_at(int(v)).vertices.push_back(int(v));
    return parts;
}

// Points that move with a curve, to find the motion by.
void add_points(const CurveGeometry<3>& curve, std::vector<Vec<3>>& out) {
    visit_one(
        [&](const auto& c) {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<3>>)
                out.push_back(c.origin), out.push_back(c.origin + c.direction);
            else if constexpr (std::same_as<C, Conic<3>>)
                out.push_back(c.centre), out.push_back(c.centre + c.x), out.push_back(c.centre + c.y);
            else
                for (const auto& p : c.net().flat())
                    out.push_back(Space<std::remove_cvref_t<decltype(p)>>::project(p));
        },
        curve);
}

std::vector<Vec<3>> points_of(const Model& model, const Part& part) {
    std::vector<Vec<3>> out;
    for (const int v : part.vertices) out.push_back(model.vertices[std::size_t(v)].point);
    for (const int e : part.edges)
        if (const auto& curve = model.edges[std::size_t(e)].curve) add_points(*curve, out);
    return out;
}

using Frame = std::array<Vec<3>, 3>;

Frame frame_at(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    const Vec<3> x = unit(b - a), z = unit(cross(x, c - a));
    return {x, cross(z, x), z};
}

// By three points of the part that are as far from each other and from a line as any, and their images.
std::optional<RigidMotion> motion_between(const std::vector<Vec<3>>& from, const std::vector<Vec<3>>& to) {
    if (from.size() != to.size() || from.empty()) return std::nullopt;
    std::size_t far = 0, aside = 0;
    const auto reach = [&](std::size_t i) { return norm(from[i] - from[0]); };
    for (std::size_t i = 1; i < from.size(); ++i)
        if (reach(i) > reach(far)) far = i;
    const Vec<3> along = unit(from[far] - from[0]);
    const auto off = [&](std::size_t i) { return norm(cross(along, from[i] - from[0])); };
    for (std::size_t i = 1; i < from.size(); ++i)
        if (off(i) > off(aside)) aside = i;
    if (!(off(aside) > kThin * reach(far))) return std::nullopt;
    const Frame a = frame_at(from[0], from[far], from[aside]), b = frame_at(to[0], to[far], to[aside]);
    RigidMotion m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) m.turn[std::size_t(i)][j] += b[k][i] * a[k][j];
    m.offset = to[0] - m.turned(from[0]);
    // |turn x|^2 <= (1 + |turn^T turn - 1|) |x|^2.
    double defect = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            defect = std::max(defect, std::abs(dot(m.turn[i], m.turn[j]) - (i == j ? 1.0 : 0.0)));
    m.skew = 3 * defect + 0x1p-48;
    if (!(m.skew < 1e-9)) return std::nullopt;
    return m;
}

// How far geometry is from what the motion makes of other geometry, over parameters; infinite where it is of
// another kind, or has other weights or knots.
class Comparison {
public:
    explicit Comparison(const RigidMotion& by) : by_(by) {}
    // The largest coordinates that were compared, for rounding.
    double scale() const { return scale_; }

    double operator()(const Vec<3>& a, const Vec<3>& b) { return vectors(by_(a), b); }
    double directions(const Vec<3>& a, const Vec<3>& b) { return vectors(by_.turned(a), b); }

    double operator()(const CurveGeometry<3>& a, const CurveGeometry<3>& b, const Interval& on) {
        if (a.index() != b.index()) return kInfinity;
        const double t = std::max(std::abs(on.lo), std::abs(on.hi));
        if (const auto* l = std::get_if<Line<3>>(&a)) {
            const auto& m = std::get<Line<3>>(b);
            return (*this)(l->origin, m.origin) + t * directions(l->direction, m.direction);
        }
        if (const auto* c = std::get_if<Conic<3>>(&a)) {
            const auto& d = std::get<Conic<3>>(b);
            if (c->kind != d.kind) return kInfinity;
            const bool round = c->kind == ConicKind::ellipse, open = c->kind == ConicKind::hyperbola;
            return (*this)(c->centre, d.centre) +
                   (round  ? 1
                    : open ? std::cosh(t)
                           : t * t) *
                       directions(c->x, d.x) +
                   (round  ? 1
                    : open ? std::sinh(t)
                           : t) *
                       directions(c->y, d.y);
        }
        if (const auto* s = std::get_if<Curve<Vec<3>>>(&a)) return nets(*s, std::get<Curve<Vec<3>>>(b));
        return nets(std::get<Curve<Hom<3>>>(a), std::get<Curve<Hom<3>>>(b));
    }

    double operator()(const SurfaceGeometry& a, const SurfaceGeometry& b, const Box<2>& on) {
        if (a.index() != b.index()) return kInfinity;
        if (const auto* e = std::get_if<Extrusion>(&a)) {
            const auto& f = std::get<Extrusion>(b);
            if (e->kind != f.kind) return kInfinity;
            return (*this)(e->profile, f.profile, on.side(0)) +
                   std::max(std::abs(on.lo[1]), std::abs(on.hi[1])) * directions(e->direction, f.direction);
        }
        if (const auto* r = std::get_if<Revolution>(&a)) {
            const auto& q = std::get<Revolution>(b);
            if (r->kind != q.kind) return kInfinity;
            const double profile = (*this)(r->profile, q.profile, on.side(1)),
                         origin = (*this)(r->origin, q.origin), axis = directions(r->axis, q.axis);
            if (!(profile < kInfinity)) return kInfinity;
            // Turning by u about an axis that is off by d moves points at the distance r by less than 5 d r.
            return profile + 2 * origin + 5 * axis * reach(q.profile, q.origin, on.side(1));
        }
        if (const auto* s = std::get_if<Surface<Vec<3>>>(&a)) return nets(*s, std::get<Surface<Vec<3>>>(b));
        if (const auto* s = std::get_if<Surface<Hom<3>>>(&a)) return nets(*s, std::get<Surface<Hom<3>>>(b));
        return kInfinity;  // offsets: their normals are not linear in what is given
    }

private:
    double vectors(const Vec<3>& a, const Vec<3>& b) {
        scale_ = std::max({scale_, max_abs(a), max_abs(b)});
        return norm(a - b);
    }

    template <std::size_t N, class P>
    double nets(const Patch<N, P>& a, const Patch<N, P>& b) {
        if (!(a.bases() == b.bases()) || a.net().extent() != b.net().extent()) return kInfinity;
        double most = 0;
        const auto p = a.net().flat(), q = b.net().flat();
        for (std::size_t i = 0; i < p.size(); ++i)
            if constexpr (Space<P>::kRational) {
                if (p[i].weight() != q[i].weight() || !(p[i].weight() > 0)) return kInfinity;
                most = std::max(most, (*this)(Space<P>::project(p[i]), Space<P>::project(q[i])));
            } else {
                most = std::max(most, (*this)(p[i], q[i]));
            }
        return most;
    }

    // Of points of the curve from `o`, at most.
    static double reach(const CurveGeometry<3>& curve, const Vec<3>& o, const Interval& on) {
        const double t = std::max(std::abs(on.lo), std::abs(on.hi));
        if (const auto* l = std::get_if<Line<3>>(&curve)) return norm(l->origin - o) + t * norm(l->direction);
        if (const auto* c = std::get_if<Conic<3>>(&curve)) {
            const double x = c->kind == ConicKind::parabola ? t * t : std::cosh(t);
            return norm(c->centre - o) + (c->kind == ConicKind::ellipse ? 1 : x) * norm(c->x) +
                   (c->kind == ConicKind::ellipse ? 1 : std::max(t, x)) * norm(c->y);
        }
        std::vector<Vec<3>> points;
        add_points(curve, points);
        double most = 0;
        for (const Vec<3>& p : points) most = std::max(most, norm(p - o));
        return most;
    }

    const RigidMotion& by_;
    double scale_ = 0;
};

int place_in(const std::vector<int>& sorted, int x) {
    return int(std::lower_bound(sorted.begin(), sorted.end(), x) - sorted.begin());
}

// Everything but geometry in space.
bool are_alike(const Model& m, const Part& a, const Part& b) {
    for (std::size_t i = 0; i < a.edges.size(); ++i) {
        const Edge &e = m.edges[std::size_t(a.edges[i])], &f = m.edges[std::size_t(b.edges[i])];
        if (e.degenerate != f.degenerate || e.curve.has_value() != f.curve.has_value() ||
            !(e.range.lo == f.range.lo && e.range.hi == f.range.hi) || e.tolerance != f.tolerance ||
            place_in(a.vertices, e.start) != place_in(b.vertices, f.start) ||
            place_in(a.vertices, e.end) != place_in(b.vertices, f.end))
            return false;
    }
    for (std::size_t i = 0; i < a.vertices.size(); ++i)
        if (m.vertices[std::size_t(a.vertices[i])].tolerance !=
            m.vertices[std::size_t(b.vertices[i])].tolerance)
            return false;
    for (std::size_t i = 0; i < a.faces.size(); ++i) {
        const Face &f = m.faces[std::size_t(a.faces[i])], &g = m.faces[std::size_t(b.faces[i])];
        if (f.reversed != g.reversed || f.tolerance != g.tolerance || f.loops.size() != g.loops.size())
            return false;
        for (std::size_t l = 0; l < f.loops.size(); ++l) {
            const auto &p = f.loops[l].coedges, &q = g.loops[l].coedges;
            if (p.size() != q.size()) return false;
            for (std::size_t c = 0; c < p.size(); ++c)
                if (p[c].reversed != q[c].reversed || !(p[c].curve == q[c].curve) ||
                    place_in(a.edges, p[c].edge) != place_in(b.edges, q[c].edge))
                    return false;
        }
    }
    return true;
}

// A box of the parameters of the face: what is inside its loops is within that of their curves.
Box<2> parameters_of(const Model& model, const Face& face) {
    Box<2> box;
    for (const Loop& l : face.loops)
        for (const Coedge& c : l.coedges) {
            const Interval on = model.edges[std::size_t(c.edge)].range;
            if (const auto* line = std::get_if<Line<2>>(&c.curve)) {
                box.add(line->origin + on.lo * line->direction);
                box.add(line->origin + on.hi * line->direction);
            } else if (const auto* conic = std::get_if<Conic<2>>(&c.curve)) {
                const double t = std::max(std::abs(on.lo), std::abs(on.hi)),
                             most = conic->kind == ConicKind::ellipse     ? 1
                                    : conic->kind == ConicKind::hyperbola ? std::cosh(t)
                                                                          : std::max(t, t * t);
                for (const double s : {-most, most})
                    for (const double r : {-most, most}) box.add(conic->centre + s * conic->x + r * conic->y);
            } else if (const auto* s = std::get_if<Curve<Vec<2>>>(&c.curve)) {
                for (const auto& p : s->net().flat()) box.add(p);
            } else {
                for (const auto& p : std::get<Curve<Hom<2>>>(c.curve).net().flat())
                    box.add(Space<std::remove_cvref_t<decltype(p)>>::project(p));
            }
        }
    return box;
}

// How far each face is from the moved one; nothing if one is further than readers round.
std::optional<std::vector<double>> distances(const Model& m, const Part& a, const Part& b,
                                             const RigidMotion& by) {
    Comparison apart(by);
    double edges = 0, scale = 0;
    for (const Part* p : {&a, &b})
        for (const int v : p->vertices) scale = std::max(scale, max_abs(m.vertices[std::size_t(v)].point));
    const double most = kAlike * scale;
    for (std::size_t i = 0; i < a.vertices.size(); ++i)
        edges = std::max(edges, apart(m.vertices[std::size_t(a.vertices[i])].point,
                                      m.vertices[std::size_t(b.vertices[i])].point));
    for (std::size_t i = 0; i < a.edges.size() && edges <= most; ++i)
        if (const Edge& e = m.edges[std::size_t(a.edges[i])], &f = m.edges[std::size_t(b.edges[i])]; e.curve)
            edges = std::max(edges, apart(*e.curve, *f.curve, e.range));
    std::vector<double> out;
    for (std::size_t i = 0; i < a.faces.size() && edges <= most; ++i) {
        const Face& f = m.faces[std::size_t(a.faces[i])];
        const double own = apart(f.surface, m.faces[std::size_t(b.faces[i])].surface, parameters_of(m, f));
        if (!(own <= most)) return std::nullopt;
        out.push_back(std::max(edges, own));
    }
    if (!(edges <= most)) return std::nullopt;
    for (double& x : out) x = x * (1 + 1e-9) + kRounding * apart.scale();
    return out;
}

std::vector<int> counts_of(const Model& m, const Part& p, const std::vector<char>& flipped) {
    std::vector<int> out{int(p.vertices.size()), int(p.edges.size())};
    for (const int f : p.faces) {
        out.push_back(2 * int(m.faces[std::size_t(f)].surface.index()) + flipped[std::size_t(f)]);
        for (const Loop& l : m.faces[std::size_t(f)].loops) out.push_back(int(l.coedges.size()));
    }
    return out;
}

}  // namespace

Copies copies_in(const Model& model) {
    Copies out;
    out.faces.resize(model.faces.size());
    std::vector<char> flipped(model.faces.size(), 0);
    for (const Shell& s : model.shells)
        for (const FaceUse& u : s.faces) flipped[std::size_t(u.face)] = u.reversed;
    const std::vector<Part> parts = parts_of(model);
    std::map<std::vector<int>, std::vector<std::size_t>> patterns;
    if (parts.size() < 2) return out;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Part& part = parts[i];
        if (part.faces.empty()) continue;
        auto& like = patterns[counts_of(model, part, flipped)];
        bool found = false;
        for (std::size_t k = 0; k < like.size() && !found; ++k) {
            const Part& pattern = parts[like[k]];
            if (!are_alike(model, pattern, part)) continue;
            const auto by = motion_between(points_of(model, pattern), points_of(model, part));
            if (!by) continue;
            const auto far = distances(model, pattern, part, *by);
            if (!far) continue;
            for (std::size_t f = 0; f < part.faces.size(); ++f)
                out.faces[std::size_t(part.faces[f])] = {pattern.faces[f], int(out.motions.size()),
                                                         (*far)[f]};
            out.motions.push_back(*by);
            found = true;
        }
        if (!found && like.size() < kPatterns) like.push_back(i);
    }
    return out;
}

Model originals_of(const Model& model, const Copies& copies) {
    Model out;
    out.unit = model.unit;
    out.vertices = model.vertices;
    out.edges = model.edges;
    std::vector<int> at(model.faces.size(), -1);
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        if (copies.faces[f].of < 0) at[f] = int(out.faces.size()), out.faces.push_back(model.faces[f]);
    for (const Shell& s : model.shells) {
        out.shells.push_back({{}, s.closed});
        for (const FaceUse& u : s.faces)
            if (at[std::size_t(u.face)] >= 0)
                out.shells.back().faces.push_back({at[std::size_t(u.face)], u.reversed});
    }
    return out;
}

}  // namespace freiform
