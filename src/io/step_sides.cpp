// Edges along the ends of splines, and along the profiles of extrusions. Where they are is known without
// looking for feet, which are many where a surface folds, or where an extrusion lies in the plane of its
// profile.
#include "step_trace.hpp"

namespace freiform::step {

namespace {

// How far above a place of the profile the point is.
double height(const Extrusion& s, double u, const Vec<3>& p) {
    return dot(p - jet<0>(s.profile, u).value(), s.direction) / dot(s.direction, s.direction);
}

}  // namespace

std::vector<Line<2>> lines_along_sides(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                       double accuracy) {
    const auto* extrusion = std::get_if<Extrusion>(&chart.surface());
    for (int k = 0; k < 2; ++k)
        if (chart.period(k) > 0 || (!chart.is_spline(k) && !(extrusion && k == 1))) return {};
    const Vec<3> begin = jet<0>(c, on.lo).value(), end = jet<0>(c, on.hi).value();
    std::vector<Line<2>> out;
    for (int k = 0; k < (extrusion ? 1 : 2); ++k) {
        const Interval &along = chart.whole()[std::size_t(k)], &across = chart.whole()[std::size_t(1 - k)];
        std::vector<Vec<2>> ways{{{along.lo, along.hi}}, {{along.hi, along.lo}}};
        if (along.lo <= on.lo && on.hi <= along.hi) ways.push_back({{on.lo, on.hi}});
        for (const Vec<2>& way : ways) {
            const std::vector<double> sides = extrusion ? std::vector{height(*extrusion, way[0], begin)}
                                                        : std::vector{across.lo, across.hi};
            for (const double side : sides) {
                Vec<2> from, to;
                from[k] = way[0], to[k] = way[1];
                from[1 - k] = to[1 - k] = side;
                if (!(norm(chart.point(from) - begin) <= accuracy) ||
                    !(norm(chart.point(to) - end) <= accuracy))
                    continue;
                const Vec<2> d = (1 / on.length()) * (to - from);
                out.push_back({from - on.lo * d, d});
            }
        }
    }
    return out;
}

}  // namespace freiform::step
