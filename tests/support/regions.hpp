// Paths that bound regions: random and nasty ones, and their winding numbers by another way than the
// library's operations take.
#pragma once
#include "random.hpp"

#include <freiform/region/boolean.hpp>
#include <freiform/trim/inside.hpp>

namespace freiform::test {

inline CurveGeometry<2> geometry_of(const PathSegment& s) {
    return std::visit([](auto c) -> CurveGeometry<2> { return c; }, curve_of({s.front(), {s}, false}));
}

// Open subpaths closed by a line.
inline InsideQuery inside_query(const Path& path) {
    std::vector<std::vector<CurveGeometry<2>>> loops;
    for (const Subpath& s : path.subpaths) {
        if (s.segments.empty()) continue;
        std::vector<CurveGeometry<2>> loop;
        for (const PathSegment& segment : s.segments) loop.push_back(geometry_of(segment));
        if (s.segments.back().back() != s.start)
            loop.push_back(geometry_of({1, {s.segments.back().back(), s.start}, 1}));
        loops.push_back(std::move(loop));
    }
    return must(InsideQuery::make(loops, 0));
}

inline bool is_in(FillRule rule, int winding) {
    return rule == FillRule::nonzero ? winding != 0 : winding % 2 != 0;
}
inline bool is_in(RegionOperation o, bool a, bool b) {
    return o == RegionOperation::union_of       ? a || b
           : o == RegionOperation::intersection ? a && b
           : o == RegionOperation::difference   ? a && !b
                                                : a != b;
}

inline Path path_from(std::string_view data) { return parse_path_data(data).path; }

struct PathOptions {
    int segments = 6;
    bool lattice = false;  // coordinates are small integers
    bool lines = false;    // nothing else
    double size = 4;
};

// A closed subpath of lines, quadratics, conics and cubics with corners anywhere: it crosses itself.
inline Subpath random_loop(Random& random, const PathOptions& o) {
    const auto point = [&] {
        return o.lattice
                   ? Vec<2>{{double(random.integer(0, int(o.size))), double(random.integer(0, int(o.size)))}}
                   : Vec<2>{{random.real(0, o.size), random.real(0, o.size)}};
    };
    Subpath out{point(), {}, true};
    Vec<2> at = out.start;
    for (int i = 0; i < o.segments; ++i) {
        PathSegment s;
        s.degree = o.lines ? 1 : random.integer(1, 3);
        s.points = {at, point(), point(), point()};
        if (s.degree == 2 && random.chance(0.5)) s.weight = o.lattice ? 0.5 : random.real(0.1, 1.5);
        if (i + 1 == o.segments) s.points[std::size_t(s.degree)] = out.start;
        at = s.back();
        out.segments.push_back(s);
    }
    return out;
}
inline Path random_path(Random& random, const PathOptions& o) {
    Path out;
    for (int i = random.integer(1, 2); i > 0; --i) out.subpaths.push_back(random_loop(random, o));
    return out;
}

inline Path moved(const Path& path, double turn, double scale, const Vec<2>& by) {
    const double c = scale * std::cos(turn), s = scale * std::sin(turn);
    return transformed(path, Affinity<2>{{{{c, -s}, {s, c}}}, by});
}

inline Subpath polygon(std::vector<Vec<2>> corners) {
    Subpath out{corners[0], {}, true};
    for (std::size_t i = 0; i < corners.size(); ++i)
        out.segments.push_back({1, {corners[i], corners[(i + 1) % corners.size()]}, 1});
    return out;
}
inline Subpath rectangle(double x0, double y0, double x1, double y1) {
    return polygon({{{x0, y0}}, {{x1, y0}}, {{x1, y1}}, {{x0, y1}}});
}

}  // namespace freiform::test
