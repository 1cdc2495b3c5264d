// Discretisation of edges.
//
// Notation: C curve of the edge, p = (u, v) parameter curve on a face with surface S, chord c(t) linear
// between p(a) and p(b), L(t) linear between the mesh points at a and b, h = b - a, Q as in
// curvature_tree.cpp, M over the box that contains p([a, b]). Bounds on [a, b]:
//   |C(t) - linear|        <= h^2/8 max|C''|
//   |S(p(t)) - linear|     <= h^2/8 max|(S o p)''|,  (S o p)'' = D^2 S(p', p') + S_u u'' + S_v v''
//   |S(c(t)) - linear|     <= Q(p(b) - p(a)) / 8
//   |p(t) - c(t)|          <= h^2/8 max|p''|, component by component: the sliver between chord and curve.
// A point of the sliver lies on a segment from p(t) to c(t); S along it stays within Q(p(t) - c(t)) / 8 of
// the chord of its ends, and both ends are near L(t). So the faces' region outside the polygon is within
//   max(|S o p - L|, |S o c - L|) + Q(sliver) / 8
// of the mesh edge, not counting the gap between S(p) and the mesh points, which the model brings along.
// A segment that seems to need k parts is cut at floor(k/2)/k of it, so that even curvature gives k equal
// parts. Triangles with the chord as longest side have error at most Q(p(b) - p(a)) / 6 (R^2 <= longest^2 /
// 3).
#include "edge_mesh_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/mesh/face_mesh.hpp>
#include <freiform/mesh/normal_cone.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kConeOfAngle =
    0.375;  // of the angle, what half a cone along a segment may have: triangles reach farther
constexpr int kClosedParts = 4;  // a closed edge must not collapse to a slit

// Where to cut an interval that seems to need `parts` parts: so that equal ones result if it does.
double first_part(double parts, int least) {
    constexpr double kMost = 1e6;
    const double k = std::max({2.0, double(least), std::ceil(parts * (1 + 1e-9))});
    return k < kMost ? std::floor(k / 2) / k : 0.5;
}

}  // namespace

CurveGeometry<1> component_of(const CurveGeometry<2>& curve, int i) {
    return std::visit(
        [&](const auto& c) -> CurveGeometry<1> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<2>>) {
                return Line<1>{{{c.origin[i]}}, {{c.direction[i]}}};
            } else if constexpr (std::same_as<C, Conic<2>>) {
                return Conic<1>{c.kind, {{c.centre[i]}}, {{c.x[i]}}, {{c.y[i]}}};
            } else if constexpr (std::same_as<C, Curve<Vec<2>>>) {
                std::vector<Vec<1>> p;
                for (const auto& q : c.net().flat()) p.push_back({{q[i]}});
                return Curve<Vec<1>>::trusted(c.bases(), Net<1, Vec<1>>(c.net().extent(), std::move(p)));
            } else {
                std::vector<Hom<1>> p;
                for (const auto& q : c.net().flat()) p.push_back({{q[i], q.weight()}});
                return Curve<Hom<1>>::trusted(c.bases(), Net<1, Hom<1>>(c.net().extent(), std::move(p)));
            }
        },
        curve);
}

EdgeMesher::EdgeMesher(const Model& model, std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> faces)
    : model_(model), faces_(faces), edges_(model.edges.size()) {
    for (std::size_t e = 0; e < model.edges.size(); ++e)
        if (model.edges[e].curve)
            edges_[e].curve = std::make_unique<DerivativeQuery<1, 3>>(*model.edges[e].curve);
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (std::size_t l = 0; l < model.faces[f].loops.size(); ++l) {
            const auto& coedges = model.faces[f].loops[l].coedges;
            for (std::size_t c = 0; c < coedges.size(); ++c) {
                auto use = std::make_unique<CoedgeQuery>();
                use->face = int(f), use->loop = int(l), use->index = int(c);
                use->coedge = &coedges[c];
                use->curve = std::make_unique<DerivativeQuery<1, 2>>(coedges[c].curve);
                edges_[std::size_t(coedges[c].edge)].uses.push_back(std::move(use));
            }
        }
}

Vec<3> EdgeMesher::position(int edge, double t) const {
    const Edge& e = model_.edges[std::size_t(edge)];
    if (e.curve) return jet<0>(*e.curve, t).value();
    const auto& uses = edges_[std::size_t(edge)].uses;
    if (e.degenerate || uses.empty()) return model_.vertices[std::size_t(e.start)].point;
    const auto& use = *uses.front();
    return jet<0>(model_.faces[std::size_t(use.face)].surface, jet<0>(use.coedge->curve, t).value().c)
        .value();
}

void EdgeMesher::forget() {
    for (EdgeMesh& mesh : edges_) mesh.parameters.clear(), mesh.points.clear(), mesh.bound = 0;
}

SegmentError EdgeMesher::error(int edge, double a, double b, bool turns) const {
    const EdgeMesh& mesh = edges_[std::size_t(edge)];
    const Edge& e = model_.edges[std::size_t(edge)];
    const double h = b - a, h2 = h * h / 8;
    SegmentError out;
    if (mesh.curve) out.polyline = h2 * (*mesh.curve)({Interval{a, b}})(2);
    for (const auto& use : mesh.uses) {
        const DerivativeQuery<2, 3>& surface = *faces_[std::size_t(use->face)];
        const PlaneCurveBounds plane = coordinate_bounds(*use->curve, {a, b});
        const DerivativeBounds<1>&du = plane.coordinate[0], &dv = plane.coordinate[1];
        const Vec<2> from = jet<0>(use->coedge->curve, a).value(), to = jet<0>(use->coedge->curve, b).value();
        const Vec<2> chord = to - from, sag{{h2 * du(2), h2 * dv(2)}};
        Box<2> box;
        for (const Vec<2>& p : {from, to}) {
            box.add(p - sag);
            box.add(p + sag);
        }
        const auto s = surface({box.side(0), box.side(1)});
        const auto along = [&](double x, double y) {
            return s(2, 0) * x * x + 2 * s(1, 1) * std::abs(x * y) + s(0, 2) * y * y;
        };
        const double kinks =
            kink_bound_of(surface.kinks(0), box.side(0)) + kink_bound_of(surface.kinks(1), box.side(1));
        out.triangle = std::max(out.triangle, along(chord[0], chord[1]) / 6 + kinks);
        out.sliver = std::max(out.sliver, along(sag[0], sag[1]) / 8 + kinks);
        if (e.degenerate) continue;
        if (turns) out.turn = std::max(out.turn, normal_cone(surface, box).angle);
        // The largest stretch of the surface's first derivative: exact in the middle of the box, plus its
        // variation.
        const Vec<2> size = box.hi - box.lo, middle = from + 0.5 * chord;
        const auto j = jet<1>(model_.faces[std::size_t(use->face)].surface, middle.c);
        const double uu = dot(j.d[1], j.d[1]), vv = dot(j.d[2], j.d[2]), uv = dot(j.d[1], j.d[2]);
        const double stretch = 1.0000001 * std::sqrt((uu + vv + std::hypot(uu - vv, 2 * uv)) / 2) +
                               (s(2, 0) + s(1, 1)) * size[0] / 2 + (s(1, 1) + s(0, 2)) * size[1] / 2;
        const double bend = std::min(s(1, 0) * du(2) + s(0, 1) * dv(2), stretch * plane.both(2));
        out.polyline = std::max(
            {out.polyline, h2 * (along(du(1), dv(1)) + bend) + kinks, along(chord[0], chord[1]) / 8 + kinks});
    }
    return out;
}

// How many segments the curvature at samples asks for: tells hopeless tolerances before they take time. Only
// an estimate; bounds over long intervals would be far too large for it.
double EdgeMesher::estimate(int edge, double tolerance) const {
    constexpr int kSamples = 8;
    const Edge& e = model_.edges[std::size_t(edge)];
    if (!e.curve) return 0;
    const double h = e.range.length() / kSamples;
    double sum = 0;
    for (int k = 0; k < kSamples; ++k)
        sum += std::sqrt(norm(jet<2>(*e.curve, e.range.lo + (k + 0.5) * h)(2)) * h * h / 8 / tolerance);
    return std::isfinite(sum) ? sum : 0;
}

Result<void> EdgeMesher::discretise(int edge, double tolerance, double longest, double angle,
                                    std::size_t max_segments) {
    EdgeMesh& mesh = edges_[std::size_t(edge)];
    const Edge& e = model_.edges[std::size_t(edge)];
    const Interval on = e.range;
    std::vector<double> must{on.lo, on.hi};
    const auto add_kinks = [&](std::span<const Kink> kinks) {
        for (const Kink& k : kinks)
            if (on.lo < k.at && k.at < on.hi) must.push_back(k.at);
    };
    if (mesh.curve) add_kinks(mesh.curve->kinks(0));
    for (const auto& use : mesh.uses) add_kinks(use->curve->kinks(0));
    std::sort(must.begin(), must.end());
    must.erase(std::unique(must.begin(), must.end()), must.end());

    if (const double needed = estimate(edge, tolerance); needed > kFarBeyond * double(max_segments))
        return refuse(
            RefusalKind::limit, "max_triangles",
            text("edge ", edge, " needs about ", std::ceil(needed), " segments within ", tolerance));
    mesh.parameters = {on.lo};
    mesh.bound = 0;
    struct Part {
        double a, b;
        int least;  // parts that it is cut into
    };
    const bool closed = e.start == e.end && !e.degenerate;
    std::vector<Part> stack;
    for (std::size_t i = must.size() - 1; i-- > 0;)
        stack.push_back(
            {must[i], must[i + 1], closed ? std::max(kClosedParts / int(must.size() - 1), 1) : 1});
    while (!stack.empty()) {
        const auto [a, b, least] = stack.back();
        stack.pop_back();
        const bool turns = std::isfinite(angle);
        const SegmentError err = error(edge, a, b, turns);
        const double length = e.degenerate || !(std::isfinite(longest) || turns)
                                  ? 0
                                  : norm(position(edge, b) - position(edge, a));
        // Errors fall with the square of the length, that of the sliver with the fourth power.
        const double excess = std::max(
            {err.polyline / tolerance, err.triangle / tolerance, std::sqrt(32 * err.sliver / tolerance)});
        // Normals turn twice as much over the segment as over the cone's half.
        const double turn = length > kAngleFloor * tolerance ? err.turn / (kConeOfAngle * angle) : 0;
        const bool done = length <= longest && turn <= 1 && excess <= 1 &&
                          std::isfinite(err.polyline + err.triangle + err.sliver);
        const double share =
            first_part(std::max({std::sqrt(excess), length / longest, std::min(turn, 2.0)}), least);
        const double middle = a + (b - a) * share;
        if ((done && least <= 1) || !(a < middle && middle < b)) {
            if (!done)
                return refuse(RefusalKind::ill_conditioned, text("edges[", edge, "]"),
                              text("cannot be brought within ", tolerance, " near parameter ", a));
            mesh.parameters.push_back(b);
            mesh.bound = std::max(mesh.bound, err.polyline + err.sliver);
            continue;
        }
        if (mesh.parameters.size() + stack.size() > max_segments)
            return refuse(
                RefusalKind::limit, "max_triangles",
                text("edge ", edge, " needs more than ", max_segments, " segments within ", tolerance));
        stack.push_back({middle, b, int(std::ceil(least * (1 - share)))});
        stack.push_back({a, middle, int(std::ceil(least * share))});
    }
    return {};
}

void EdgeMesher::split(int edge, int index) {
    auto& t = edges_[std::size_t(edge)].parameters;
    const double a = t[std::size_t(index)], b = t[std::size_t(index) + 1], middle = a + (b - a) / 2;
    if (a < middle && middle < b) t.insert(t.begin() + index + 1, middle);
}

}  // namespace freiform
