#include "face_box_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/model/model.hpp>
#include <freiform/spline/derivative_bounds.hpp>
#include <freiform/spline/hull_box.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

Result<void> check_index(int i, std::size_t size, std::string where) {
    if (i < 0 || std::size_t(i) >= size)
        return refuse(RefusalKind::invalid, std::move(where),
                      text("index ", i, " is outside 0..", (long long)(size)-1));
    return {};
}

Result<void> check_number(double x, std::string where) {
    if (!std::isfinite(x))
        return refuse(RefusalKind::nonfinite, std::move(where), text(x, " is not a finite number"));
    return {};
}

Result<void> check_tolerance(double x, std::string where) {
    if (auto ok = check_number(x, where); !ok) return ok;
    if (x < 0)
        return refuse(RefusalKind::invalid, std::move(where), text("the tolerance ", x, " is negative"));
    return {};
}

// The interval must lie in the domain of the curve, which for analytic curves is all of the line.
template <int D>
Result<void> check_curve(const CurveGeometry<D>& curve, Interval on, std::string_view where) {
    if (auto ok = check(curve); !ok) return refuse_within(where, ok.error());
    const bool periodic = std::holds_alternative<Conic<D>>(curve);
    const Interval d = domain(curve)[0];
    const double slack =
        1e-9 * (d.hi - d.lo);  // readers clamp to the domain within the rounding of their files
    if (!periodic && !(on.lo >= d.lo - slack && on.hi <= d.hi + slack))
        return refuse(
            RefusalKind::out_of_domain, std::string(where),
            text("the range [", on.lo, ", ", on.hi, "] leaves the domain [", d.lo, ", ", d.hi, "]"));
    return {};
}

Result<void> check_layers(const Model& m, const std::vector<int>& layers, std::string_view where) {
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (auto ok = check_index(layers[i], m.layers.size(), text(where, ".layers[", i, "]")); !ok)
            return ok;
    return {};
}

Result<void> check_edge(const Model& m, const Edge& e, std::string_view where) {
    if (auto ok = check_layers(m, e.layers, where); !ok) return ok;
    if (auto ok = check_index(e.start, m.vertices.size(), text(where, ".start")); !ok) return ok;
    if (auto ok = check_index(e.end, m.vertices.size(), text(where, ".end")); !ok) return ok;
    if (auto ok = check_tolerance(e.tolerance, text(where, ".tolerance")); !ok) return ok;
    if (auto ok = check_number(e.range.hi - e.range.lo, text(where, ".range")); !ok) return ok;
    if (!(e.range.lo < e.range.hi))
        return refuse(RefusalKind::invalid, text(where, ".range"),
                      text("[", e.range.lo, ", ", e.range.hi, "] is empty"));
    if (e.degenerate && (e.curve || e.start != e.end))
        return refuse(RefusalKind::invalid, std::string(where),
                      "is degenerate, but has a curve or two vertices");
    if (!e.curve) return {};
    return check_curve(*e.curve, e.range, text(where, ".curve"));
}

Result<void> check_face(const Model& m, const Face& f, std::string_view where) {
    if (auto ok = check(f.surface); !ok) return refuse_within(text(where, ".surface"), ok.error());
    if (auto ok = check_tolerance(f.tolerance, text(where, ".tolerance")); !ok) return ok;
    if (auto ok = check_layers(m, f.layers, where); !ok) return ok;
    for (std::size_t l = 0; l < f.loops.size(); ++l) {
        const auto& coedges = f.loops[l].coedges;
        const std::string loop = text(where, ".loops[", l, "]");
        if (coedges.empty()) return refuse(RefusalKind::invalid, loop, "has no edges");
        for (std::size_t c = 0; c < coedges.size(); ++c) {
            const std::string at = text(loop, "[", c, "]");
            if (auto ok = check_index(coedges[c].edge, m.edges.size(), text(at, ".edge")); !ok) return ok;
            const Edge& e = m.edges[std::size_t(coedges[c].edge)];
            if (auto ok = check_curve(coedges[c].curve, e.range, text(at, ".curve")); !ok) return ok;
        }
    }
    return {};
}

// How far the curve or surface over `part` may leave the linear interpolant of its corners: within Q / 8
// (curvature_tree.cpp), coordinate by coordinate; kinks add their own bound.
template <std::size_t N, int D>
Vec<D> slack_of(const DerivativeQuery<N, D>& query, const std::array<Interval, N>& part) {
    Vec<D> slack;
    for (int i = 0; i < D; ++i) {
        Vec<D> axis{};
        axis[i] = 1;
        const auto bounds = query.along(axis, part);
        const double du = part[0].length(), dv = part[N - 1].length();
        if constexpr (N == 1)
            slack[i] = bounds(2) * du * du / 8;
        else
            slack[i] = (bounds(2, 0) * du * du + 2 * bounds(1, 1) * du * dv + bounds(0, 2) * dv * dv) / 8;
        for (std::size_t d = 0; d < N; ++d) slack[i] += kink_bound_of(query.kinks(int(d)), part[d]);
    }
    return slack;
}

// A box that contains the curve or surface over `on`: that of the corners of several cells, wider by their
// slack, or of their control points where that is the smaller one. Of curves, cells with much slack are
// halved.
template <std::size_t N, int D>
Box<D> box_of(const typename GeometryOf<N, D>::type& geometry, const std::array<Interval, N>& on) {
    constexpr int kCells = N == 1 ? 16 : 8, kHalvings = N == 1 ? 6 : 0;
    constexpr double kLittle = 1.0 / 256;  // of the diagonal
    const DerivativeQuery<N, D> query(geometry);
    const auto value = [&](const std::array<double, N>& at) {
        if constexpr (N == 1)
            return jet<0>(geometry, at[0]).value();
        else
            return jet<0>(geometry, at).value();
    };
    struct Cell {
        std::array<Interval, N> part;
        int depth = 0;
    };
    std::vector<Cell> stack;
    Index<N> cells{}, corners{};
    for (auto& c : cells) c = kCells;
    for (auto& c : corners) c = 2;
    Box<D> box, points_only;
    each_index(cells, [&](const Index<N>& cell) {
        Cell next;
        for (std::size_t d = 0; d < N; ++d) {
            const double h = on[d].length() / kCells;
            next.part[d] = {on[d].lo + cell[d] * h,
                            cell[d] + 1 == kCells ? on[d].hi : on[d].lo + (cell[d] + 1) * h};
        }
        std::array<double, N> middle{};
        for (std::size_t d = 0; d < N; ++d) middle[d] = next.part[d].middle();
        points_only.add(value(middle));
        stack.push_back(next);
    });
    const double little = kLittle * points_only.diagonal();
    while (!stack.empty()) {
        const Cell cell = stack.back();
        stack.pop_back();
        Vec<D> slack = slack_of<N, D>(query, cell.part);
        if (!(max_abs(slack) <= little) && cell.depth < kHalvings) {
            const double middle = cell.part[0].middle();
            for (int half = 0; half < 2; ++half) {
                Cell next{cell.part, cell.depth + 1};
                (half == 0 ? next.part[0].hi : next.part[0].lo) = middle;
                stack.push_back(next);
            }
            continue;
        }
        slack += Box<D>::filled(value_error_bound(geometry, cell.part));
        if (!is_finite(slack)) slack = Box<D>::filled(kInfinity);  // a spline that jumps
        Box<D> around;
        each_index(corners, [&](const Index<N>& i) {
            std::array<double, N> at{};
            for (std::size_t d = 0; d < N; ++d) at[d] = i[d] == 0 ? cell.part[d].lo : cell.part[d].hi;
            const Vec<D> p = value(at);
            around.add(p - slack);
            around.add(p + slack);
        });
        if (const auto hull = hull_box(geometry, cell.part)) around = common(around, *hull);
        box.add(around);
    }
    return box;
}

// Contains the loops of the face; without loops the domain.
std::array<Interval, 2> parameter_box(const Model& m, const Face& f) {
    const auto whole = domain(f.surface);
    if (f.loops.empty()) return whole;
    Box<2> box;
    for (const Loop& l : f.loops)
        for (const Coedge& c : l.coedges)
            box.add(box_of<1, 2>(c.curve, {m.edges[std::size_t(c.edge)].range}));
    std::array<Interval, 2> on{box.side(0), box.side(1)};
    if (visit_one(
            [](const auto& s) {
                return requires { s.net(); };
            },
            f.surface))
        for (std::size_t d = 0; d < 2; ++d) {
            on[d].lo = std::clamp(on[d].lo, whole[d].lo, whole[d].hi);
            on[d].hi = std::clamp(on[d].hi, on[d].lo, whole[d].hi);
        }
    return on;
}

// A plane face is in the convex hull of its boundary.
bool is_flat_within_edges(const Model& m, const Face& f) {
    const auto* extrusion = std::get_if<Extrusion>(&f.surface);
    if (!extrusion || !std::holds_alternative<Line<3>>(extrusion->profile) || f.loops.empty()) return false;
    for (const Loop& l : f.loops)
        for (const Coedge& c : l.coedges)
            if (!m.edges[std::size_t(c.edge)].curve) return false;
    return true;
}

}  // namespace

Result<Model> make_model(Model m) {
    for (std::size_t i = 0; i < m.vertices.size(); ++i) {
        if (!is_finite(m.vertices[i].point))
            return refuse(RefusalKind::nonfinite, text("vertices[", i, "]"), "a coordinate is not finite");
        if (auto ok = check_tolerance(m.vertices[i].tolerance, text("vertices[", i, "].tolerance")); !ok)
            return std::unexpected(ok.error());
    }
    for (std::size_t i = 0; i < m.edges.size(); ++i)
        if (auto ok = check_edge(m, m.edges[i], text("edges[", i, "]")); !ok)
            return std::unexpected(ok.error());
    for (std::size_t i = 0; i < m.faces.size(); ++i)
        if (auto ok = check_face(m, m.faces[i], text("faces[", i, "]")); !ok)
            return std::unexpected(ok.error());
    for (std::size_t i = 0; i < m.shells.size(); ++i)
        for (std::size_t k = 0; k < m.shells[i].faces.size(); ++k)
            if (auto ok = check_index(m.shells[i].faces[k].face, m.faces.size(),
                                      text("shells[", i, "].faces[", k, "]"));
                !ok)
                return std::unexpected(ok.error());
    for (std::size_t i = 0; i < m.bodies.size(); ++i)
        for (std::size_t k = 0; k < m.bodies[i].shells.size(); ++k)
            if (auto ok = check_index(m.bodies[i].shells[k], m.shells.size(),
                                      text("bodies[", i, "].shells[", k, "]"));
                !ok)
                return std::unexpected(ok.error());
    for (std::size_t i = 0; i < m.bodies.size(); ++i)
        if (auto ok = check_layers(m, m.bodies[i].layers, text("bodies[", i, "]")); !ok)
            return std::unexpected(ok.error());
    return m;
}

ModelSummary summary(const Model& m) {
    ModelSummary s;
    s.vertices = int(m.vertices.size());
    s.edges = int(m.edges.size());
    s.faces = int(m.faces.size());
    s.shells = int(m.shells.size());
    s.bodies = int(m.bodies.size());
    s.solids = int(std::count_if(m.bodies.begin(), m.bodies.end(), [](const Body& b) { return b.solid; }));
    std::vector<int> uses(m.edges.size());
    for (const Face& f : m.faces)
        for (const Loop& l : f.loops)
            for (std::size_t c = 0; c < l.coedges.size(); ++c) {
                ++uses[std::size_t(l.coedges[c].edge)];
                for (std::size_t k = 0; k < c; ++k)
                    if (l.coedges[k].edge == l.coedges[c].edge) ++s.seams;
            }
    for (std::size_t i = 0; i < m.edges.size(); ++i) {
        const Edge& e = m.edges[i];
        if (e.degenerate)
            ++s.degenerate_edges;
        else if (uses[i] < 2)
            ++s.open_edges;
    }
    for (const Vertex& v : m.vertices) s.box.add(v.point);
    for (const Edge& e : m.edges)
        if (e.curve) s.box.add(box_of<1, 3>(*e.curve, {e.range}));
    const Box<3> edges = s.box;
    for (const Face& f : m.faces) {
        if (is_flat_within_edges(m, f)) continue;
        if (const auto box = box_of_face(f, m.edges, edges)) {
            if (!box->is_empty()) s.box.add(*box);
            continue;
        }
        const auto on = parameter_box(m, f);
        if (std::isfinite(on[0].length()) && std::isfinite(on[1].length()))
            s.box.add(box_of<2, 3>(f.surface, on));
    }
    return s;
}

}  // namespace freiform
