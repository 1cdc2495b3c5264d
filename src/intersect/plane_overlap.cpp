// Two parallelograms in one plane, in any position to each other: a convex polygon.
//
// Idea. Both are affine but for a twist t = P00 - P10 - P01 + P11 each, so that A(x) - B(M x) is affine in x,
// too, up to |t_A| + |t_B| over the parts; its largest size over a polygon is at a corner. M comes from four
// equations of which two suffice.
#include "same_map_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

struct Parallelogram {
    Vec<3> origin, u, v;  // over the unit square
    double twist = 0, size = 0;
    std::array<Interval, 2> on{};
    Vec<3> at(const Vec<2>& x) const { return origin + x[0] * u + x[1] * v; }
    Vec<2> own(const Vec<2>& x) const {
        return {{on[0].lo + x[0] * on[0].length(), on[1].lo + x[1] * on[1].length()}};
    }
};
std::optional<Parallelogram> parallelogram(const PartSpline& part) {
    const auto& net = part.surface.net();
    if (net.extent() != Index<2>{2, 2} || !part.map[0].is_identity() || !part.map[1].is_identity())
        return std::nullopt;
    const auto view = net.view();
    std::array<Vec<3>, 4> p;
    Parallelogram out;
    for (int i = 0; i < 4; ++i) {
        const Hom<3>& h = view({i / 2, i % 2});
        if (h.weight() != view({0, 0}).weight()) return std::nullopt;
        p[std::size_t(i)] = project(h);
        out.size = std::max(out.size, max_abs(p[std::size_t(i)]));
    }
    out.origin = p[0], out.u = p[2] - p[0], out.v = p[1] - p[0];
    out.twist = norm((p[0] - p[1]) - (p[2] - p[3]));
    out.on = part.surface.domain();
    return out;
}

// The part of a polygon with n . x <= c.
std::vector<Vec<2>> half_of(const std::vector<Vec<2>>& polygon, const Vec<2>& n, double c) {
    std::vector<Vec<2>> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec<2>&p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double a = dot(n, p) - c, b = dot(n, q) - c;
        if (a <= 0) out.push_back(p);
        if ((a < 0 && b > 0) || (a > 0 && b < 0)) out.push_back(p + (a / (a - b)) * (q - p));
    }
    return out;
}

}  // namespace

std::optional<SurfaceOverlap> plane_overlap(const PartSpline& a, const PartSpline& b, double tolerance) {
    const auto p = parallelogram(a), q = parallelogram(b);
    if (!p || !q) return std::nullopt;
    const double uu = dot(q->u, q->u), uv = dot(q->u, q->v), vv = dot(q->v, q->v), det = uu * vv - uv * uv;
    if (!(det > 0)) return std::nullopt;
    const Vec<3> s = (1 / det) * (vv * q->u - uv * q->v), t = (1 / det) * (uu * q->v - uv * q->u);
    const Vec<3> from = p->origin - q->origin;
    const Vec<2> shift{{dot(s, from), dot(t, from)}};
    const std::array<Vec<2>, 2> row{{{{dot(s, p->u), dot(s, p->v)}}, {{dot(t, p->u), dot(t, p->v)}}}};
    std::vector<Vec<2>> region{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    for (int k = 0; k < 2; ++k) {
        const Vec<2>& r = row[std::size_t(k)];
        region = half_of(half_of(region, r, 1 - shift[k]), -1.0 * r, shift[k]);
    }
    double area = 0;
    for (std::size_t i = 0; i < region.size(); ++i) area += cross(region[i], region[(i + 1) % region.size()]);
    if (!(area > 0)) return std::nullopt;
    SurfaceOverlap out;
    for (const Vec<2>& x : region) {
        Vec<2> y = shift + Vec<2>{{dot(row[0], x), dot(row[1], x)}};
        for (int k = 0; k < 2; ++k) y[k] = clamped(y[k], {0, 1});
        out.gap = std::max(out.gap, norm(p->at(x) - q->at(y)));
        out.loop_a.push_back(p->own(x)), out.loop_b.push_back(q->own(y));
    }
    out.gap =
        1.01 * (out.gap + p->twist + q->twist + 64 * kUnitRoundoff * (p->size + q->size) + a.bound + b.bound);
    return out.gap <= tolerance ? std::optional(out) : std::nullopt;
}

}  // namespace freiform::detail
