// The laws that Boolean operations of two plane paths obey, as far as bounds let them be seen.
#pragma once
#include "regions.hpp"

#include <gtest/gtest.h>

namespace freiform::test {

inline constexpr RegionOperation kAllOperations[] = {RegionOperation::union_of, RegionOperation::intersection,
                                                     RegionOperation::difference, RegionOperation::exclusion};

inline Vec<2> point_at(const PathSegment& s, double t) {
    std::array<Vec<2>, 4> p = s.points;
    if (s.degree == 2) {
        const double a = (1 - t) * (1 - t), b = 2 * t * (1 - t) * s.weight, c = t * t;
        return (1 / (a + b + c)) * (a * p[0] + b * p[1] + c * p[2]);
    }
    for (int r = 1; r <= s.degree; ++r)
        for (std::size_t i = 0; i + std::size_t(r) <= std::size_t(s.degree); ++i)
            p[i] = (1 - t) * p[i] + t * p[i + 1];
    return p[0];
}

template <class F>
void each_segment(const Path& path, F&& f) {
    for (const Subpath& s : path.subpaths) {
        for (const PathSegment& segment : s.segments) f(segment);
        if (!s.segments.empty() && s.segments.back().back() != s.start)
            f(PathSegment{1, {s.segments.back().back(), s.start}, 1});
    }
}

// From above, by points of the path: the nearest of 32, then of 32 between its neighbours, and so on.
inline double distance_from_above(const Path& path, const Vec<2>& q) {
    double best = std::numeric_limits<double>::infinity();
    each_segment(path, [&](const PathSegment& s) {
        double lo = 0, hi = 1;
        for (int round = 0; round < 10; ++round) {
            double nearest = std::numeric_limits<double>::infinity(), at = lo;
            for (int i = 0; i <= 32; ++i) {
                const double t = lo + (hi - lo) * i / 32, d = norm(point_at(s, t) - q);
                if (d < nearest) nearest = d, at = t;
            }
            best = std::min(best, nearest);
            const double step = (hi - lo) / 16;
            lo = std::max(0.0, at - step), hi = std::min(1.0, at + step);
        }
    });
    return best;
}

// Areas of the four operations agree with each other, and points are where the winding numbers of both paths
// say, all up to the bounds. The refusal where one of them is refused.
inline std::optional<Refusal> break_laws(const Filled& a, const Filled& b, Random& random,
                                         const RegionOptions& options, int points = 40) {
    Box<2> box;
    double length = 0, bound = 0;
    for (const Path* p : {&a.path, &b.path})
        each_segment(*p, [&](const PathSegment& s) {
            for (int i = 0; i <= s.degree; ++i) {
                box.add(s.points[std::size_t(i)]);
                if (i > 0) length += norm(s.points[std::size_t(i)] - s.points[std::size_t(i) - 1]);
            }
        });
    const auto ra = region_of(a, options), rb = region_of(b, options);
    if (!ra) return ra.error();
    if (!rb) return rb.error();
    const auto area = [&](const Region& r) {
        EXPECT_LE(r.bound, options.tolerance);
        const PathArea measured = signed_area(r.path);
        bound = std::max(bound, r.bound * length + 10 * r.bound * r.bound + measured.bound);
        return measured.value;
    };
    const InsideQuery in_a = inside_query(a.path), in_b = inside_query(b.path);
    std::array<double, 4> areas{};
    for (const RegionOperation o : kAllOperations) {
        const auto r = combine(a, b, o, options);
        if (!r) return r.error();
        areas[std::size_t(o)] = area(*r);
        if (box.is_empty()) continue;
        const InsideQuery in = inside_query(r->path);
        for (int i = 0; i < points; ++i) {
            const auto coordinate = [&](int d) {
                const double reach = (box.hi[d] - box.lo[d]) / 8;
                return random.real(box.lo[d] - reach, box.hi[d] + reach);
            };
            const Vec<2> p{{coordinate(0), coordinate(1)}};
            const bool wanted =
                is_in(o, is_in(a.rule, in_a.at(p).winding), is_in(b.rule, in_b.at(p).winding));
            if (in.at(p).winding == int(wanted)) continue;
            EXPECT_LE(std::min(distance_from_above(a.path, p), distance_from_above(b.path, p)), r->bound)
                << name_of(o) << ' ' << p[0] << ' ' << p[1];
        }
    }
    const auto back = combine(b, a, RegionOperation::union_of, options);
    if (!back) return back.error();
    const double whole_a = area(*ra), whole_b = area(*rb), there = area(*back), slack = 4 * bound;
    EXPECT_NEAR(areas[0], there, slack);
    EXPECT_NEAR(areas[0], whole_a + whole_b - areas[1], slack);
    EXPECT_NEAR(areas[2], whole_a - areas[1], slack);
    EXPECT_NEAR(areas[3], areas[0] - areas[1], slack);
    return {};
}

}  // namespace freiform::test
