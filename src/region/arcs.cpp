// Arcs of an arrangement: their exact form, their parts, and a proof that one does not come near a segment.
//
// Left out. A loop that runs along a line and back goes round no point. So a segment whose control points
// lie on one line, which orient2d decides exactly, may be replaced by the line between its ends, whatever
// detours it makes: winding numbers off the line stay what they are.
//
// Parts. De Casteljau twice. In homogeneous form, with rational quadratics brought to the weights 1, w, 1 by
// w = w1 / sqrt(w0 w2), which leaves the curve as it is.
//
// Accuracy. A cut of degree 3 rounds each homogeneous coordinate by at most 9.1 u of the largest
// (split_error(3), spline/bezier.hpp), weights are at most max(1, w), projections and the new weight take 8 u
// more. With weights that differ by less than 16 that is below 2^-46 of the largest coordinate; arcs of at
// most half an ellipse have weights between 0 and 1, and the weight of a part is nearer to 1.
//   may_touch halves: (a + b) / 2 rounds once, so that a level of degree 3 rounds by 3 u; 40 levels are 120
//   u,
// the projection and its test 8 u: with the factor for weights below 2^-44.
#include "arcs_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/poly/predicates.hpp>
#include <freiform/spline/bezier.hpp>

#include <cmath>
#include <map>

namespace freiform::detail {

std::array<Hom<2>, 4> homogeneous(const PathSegment& s) {
    std::array<Hom<2>, 4> h{};
    for (int i = 0; i <= s.degree; ++i)
        h[std::size_t(i)] = weighted(s.points[std::size_t(i)], s.degree == 2 && i == 1 ? s.weight : 1.0);
    return h;
}

Vec<2> point_of(const PathSegment& s, double t) {
    if (t == 0) return s.front();
    if (t == 1) return s.back();
    auto h = homogeneous(s);
    keep_left(Fibre<Hom<2>>{h.data(), s.degree + 1, 1}, t);
    return project(h[std::size_t(s.degree)]);
}

// The difference of the last two points of the construction, both projected.
Vec<2> tangent_of(const PathSegment& s, double t) {
    auto h = homogeneous(s);
    const auto n = std::size_t(s.degree);
    for (std::size_t r = 1; r < n; ++r)
        for (std::size_t i = 0; i + r <= n; ++i) h[i] = (1 - t) * h[i] + t * h[i + 1];
    return project(h[1]) - project(h[0]);
}

PathSegment part_of(const PathSegment& s, double t0, double t1) {
    if (t1 < t0) return reversed(part_of(s, t1, t0));
    if (t0 == 0 && t1 == 1) return s;
    if (s.degree == 1) return {1, {point_of(s, t0), point_of(s, t1)}, 1};
    auto h = homogeneous(s);
    const Fibre<Hom<2>> f{h.data(), s.degree + 1, 1};
    keep_left(f, t1);
    if (t0 > 0) keep_right(f, std::min(1.0, t0 / t1));
    PathSegment out = s;
    for (int i = 0; i <= s.degree; ++i) out.points[std::size_t(i)] = project(h[std::size_t(i)]);
    if (s.degree == 2 && s.weight != 1) out.weight = h[1].weight() / std::sqrt(h[0].weight() * h[2].weight());
    return out;
}

PathSegment reversed(const PathSegment& s) {
    PathSegment out = s;
    for (int i = 0; i <= s.degree; ++i) out.points[std::size_t(i)] = s.points[std::size_t(s.degree - i)];
    return out;
}

Box<2> box_of(const PathSegment& s) {
    Box<2> box;
    for (int i = 0; i <= s.degree; ++i) box.add(s.points[std::size_t(i)]);
    return box;
}

namespace {

bool is_straight(const PathSegment& s) {
    // Two different points and the others on their line.
    int far = 1;
    while (far <= s.degree && s.points[std::size_t(far)] == s.points[0]) ++far;
    for (int i = far + 1; i <= s.degree; ++i)
        if (orient2d(s.points[0], s.points[std::size_t(far)], s.points[std::size_t(i)]) != 0) return false;
    return true;
}

RegionArc arc_of(const PathSegment& s, int operand, const std::array<std::size_t, 2>& place) {
    RegionArc arc{s, operand, place, {}, {}, {}, box_of(s)};
    const auto h = homogeneous(s);
    for (std::size_t i = 0; i <= std::size_t(s.degree); ++i)
        arc.x[i] = h[i][0], arc.y[i] = h[i][1], arc.w[i] = h[i][2];
    if (arc.is_rational())
        for (int d = 0; d < 2; ++d) {
            const double slack = 0x1p-51 * std::max(std::abs(arc.box.lo[d]), std::abs(arc.box.hi[d]));
            arc.box.lo[d] -= slack, arc.box.hi[d] += slack;
        }
    return arc;
}

}  // namespace

void add_arc(PathSegment s, int operand, const std::array<std::size_t, 2>& place,
             std::vector<RegionArc>& out) {
    if (s.degree > 1 && is_straight(s)) s = {1, {s.front(), s.back()}, 1};
    if (s.degree > 1 || s.front() != s.back()) out.push_back(arc_of(s, operand, place));
}

PathSegment on_grid(PathSegment s, double grid, double scale) {
    for (int i = 0; i <= s.degree; ++i)
        for (int d = 0; d < 2; ++d) {
            double& x = s.points[std::size_t(i)][d];
            x = grid * std::nearbyint(x / grid);
        }
    if (s.degree == 2 && s.weight != 1) {
        const double step = std::exp2(std::floor(std::log2(grid / scale)));
        s.weight = std::max(step, step * std::nearbyint(s.weight / step));
    }
    return s;
}

Result<void> add_arcs(const Path& path, int operand, std::vector<RegionArc>& out) {
    for (std::size_t i = 0; i < path.subpaths.size(); ++i) {
        const Subpath& subpath = path.subpaths[i];
        if (subpath.segments.empty()) continue;
        for (std::size_t k = 0; k < subpath.segments.size(); ++k) {
            const PathSegment& s = subpath.segments[k];
            const auto where = [&] { return text("subpaths[", i, "].segments[", k, "]"); };
            FF_REQUIRE(1 <= s.degree && s.degree <= 3);
            for (int j = 0; j <= s.degree; ++j)
                if (!is_finite(s.points[std::size_t(j)]) || !(max_abs(s.points[std::size_t(j)]) < 0x1p500))
                    return refuse(RefusalKind::nonfinite, where(),
                                  "has a coordinate that is no number, or above 2^500");
            if (s.degree == 2 && !(s.weight > 0x1p-20 && s.weight < 0x1p4))
                return refuse(RefusalKind::unsupported, where(),
                              text("has the weight ", s.weight, ", and not one from 2^-20 to 16"));
            const Vec<2> from = k == 0 ? subpath.start : subpath.segments[k - 1].back();
            if (from != s.front())
                return refuse(RefusalKind::invalid, where(), "does not begin where the one before ends");
            add_arc(s, operand, {i, k}, out);
        }
        const Vec<2> end = subpath.segments.back().back();
        if (end != subpath.start)
            add_arc({1, {end, subpath.start}, 1}, operand, {i, subpath.segments.size()}, out);
    }
    return {};
}

void cancel_opposite(std::vector<RegionArc>& arcs) {
    std::map<std::array<double, 11>, std::vector<std::size_t>> open;
    const auto key = [](const RegionArc& arc, const PathSegment& s) {
        std::array<double, 11> k{double(s.degree), double(arc.operand), s.degree == 2 ? s.weight : 1};
        for (std::size_t i = 0; i <= std::size_t(s.degree); ++i)
            k[3 + 2 * i] = s.points[i][0], k[4 + 2 * i] = s.points[i][1];
        return k;
    };
    std::vector<bool> gone(arcs.size());
    for (std::size_t i = 0; i < arcs.size(); ++i) {
        const auto opposite = open.find(key(arcs[i], reversed(arcs[i].s)));
        if (opposite == open.end() || opposite->second.empty()) {
            open[key(arcs[i], arcs[i].s)].push_back(i);
            continue;
        }
        gone[i] = gone[opposite->second.back()] = true;
        opposite->second.pop_back();
    }
    std::size_t i = 0;
    std::erase_if(arcs, [&](const RegionArc&) { return gone[i++]; });
}

bool may_touch(const RegionArc& arc, Interval on, const Vec<2>& a, const Vec<2>& b, double slack) {
    constexpr int kDeepest = 40;
    Box<2> probe;
    probe.add(a), probe.add(b);
    for (int d = 0; d < 2; ++d) probe.lo[d] -= slack, probe.hi[d] += slack;
    const auto n = std::size_t(arc.s.degree);
    const Vec<2> along = b - a;
    const double width = slack * (std::abs(along[0]) + std::abs(along[1]));
    const auto apart = [&](const std::array<Hom<2>, 4>& h) {
        Box<2> box;
        double lo = kInfinity, hi = -kInfinity;
        for (std::size_t i = 0; i <= n; ++i) {
            const Vec<2> p = project(h[i]);
            box.add(p);
            const double side = cross(along, p - a);
            lo = std::min(lo, side), hi = std::max(hi, side);
        }
        return lo > width || hi < -width || !box.side(0).overlaps(probe.side(0)) ||
               !box.side(1).overlaps(probe.side(1));
    };
    struct Part {
        std::array<Hom<2>, 4> h;
        Interval at;
        int depth;
    };
    std::vector<Part> stack{{homogeneous(arc.s), {0, 1}, 0}};
    for (int looked = 0; !stack.empty(); ++looked) {
        const Part part = stack.back();
        stack.pop_back();
        if (part.at.hi <= on.lo || part.at.lo >= on.hi || apart(part.h)) continue;
        if (part.depth == kDeepest || looked > 4000) return true;
        Part left = part, right = part;
        for (std::size_t r = 1; r <= n; ++r)
            for (std::size_t i = n; i >= r; --i) left.h[i] = 0.5 * (left.h[i - 1] + left.h[i]);
        for (std::size_t r = 1; r <= n; ++r)
            for (std::size_t i = 0; i + r <= n; ++i) right.h[i] = 0.5 * (right.h[i] + right.h[i + 1]);
        left.at.hi = right.at.lo = part.at.middle();
        left.depth = right.depth = part.depth + 1;
        stack.push_back(left), stack.push_back(right);
    }
    return false;
}

}  // namespace freiform::detail
