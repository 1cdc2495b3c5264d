// Pairs of paths that are made to be hard: what they share, touch, or nearly do.
#pragma once
#include "regions.hpp"

#include <numbers>
#include <string>

namespace freiform::test {

struct NastyPair {
    std::string name;
    Path a, b;
    double tolerance = 1e-9;
};
using NastyPairs = std::vector<NastyPair>;

inline Path disc_at(double x, double y, double r) { return {{ellipse({{x, y}}, r, r)}}; }

inline Path turned_round(const Path& path) {
    Path out;
    for (const Subpath& s : path.subpaths) {
        Subpath t{s.segments.empty() ? s.start : s.segments.back().back(), {}, s.closed};
        for (auto i = s.segments.rbegin(); i != s.segments.rend(); ++i) {
            PathSegment r = *i;
            for (std::size_t k = 0; k <= std::size_t(r.degree); ++k)
                r.points[k] = i->points[std::size_t(r.degree) - k];
            t.segments.push_back(r);
        }
        out.subpaths.push_back(std::move(t));
    }
    return out;
}

inline Path both(Path a, const Path& b) {
    a.subpaths.insert(a.subpaths.end(), b.subpaths.begin(), b.subpaths.end());
    return a;
}

// Unit squares of an n x n grid: those with (i + j) % of == which.
inline Path squares(int n, int of, int which, double x = 0, double y = 0) {
    Path out;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if ((i + j) % of == which) out.subpaths.push_back(rectangle(x + i, y + j, x + i + 1, y + j + 1));
    return out;
}

// {n/k}: crosses itself where k > 1.
inline Path star_polygon(int n, int k, double phase = 0, double r = 3) {
    std::vector<Vec<2>> corners;
    for (int i = 0; i < n; ++i) {
        const double angle = phase + 2 * std::numbers::pi * (i * k % n) / n;
        corners.push_back({{r * std::cos(angle), r * std::sin(angle)}});
    }
    return {{polygon(std::move(corners))}};
}

inline void add_grids(NastyPairs& out) {
    for (const int n : {2, 3, 4}) {
        const Path black = squares(n, 2, 0), white = squares(n, 2, 1), all = squares(n, 1, 0);
        out.push_back({"black and white", black, white});
        out.push_back({"all squares and the black ones", all, turned_round(black)});
        out.push_back({"shifted by a square", all, squares(n, 1, 0, 1, 1)});
        out.push_back({"shifted by half a square", black, squares(n, 2, 0, 0.5, 0)});
        out.push_back({"shifted by a third", all, squares(n, 2, 0, 1 / 3.0, 1 / 3.0)});
    }
}

inline void add_tangent_circles(NastyPairs& out) {
    for (const double angle : {0.0, 0.7, std::numbers::pi / 4})
        for (const double r : {1.0, 0.5, 1 / 3.0}) {
            const double x = std::cos(angle), y = std::sin(angle);
            out.push_back({"circles touch outside", disc_at(0, 0, 1), disc_at((1 + r) * x, (1 + r) * y, r)});
            if (r < 1)
                out.push_back(
                    {"circles touch inside", disc_at(0, 0, 1), disc_at((1 - r) * x, (1 - r) * y, r)});
        }
    out.push_back({"a circle and its hull", disc_at(0, 0, 1), {{rectangle(-1, -1, 1, 1)}}});
}

inline void add_equal_arcs(NastyPairs& out) {
    const Path disc = disc_at(0, 0, 1), lens = path_from("M 0 0 Q 1 2 2 0 Z"),
               wave = path_from("M 0 0 C 1 3 2 -3 3 0 L 3 4 L 0 4 Z"),
               below = path_from("M 3 0 C 2 -3 1 3 0 0 L 0 -4 L 3 -4 Z");
    out.push_back({"a circle, reversed", disc, turned_round(disc)});
    out.push_back({"a circle and one with it reversed", disc, both(turned_round(disc), disc_at(0, 0, 0.5))});
    out.push_back({"both sides of a cubic", wave, below});
    out.push_back({"both sides of a cubic, reversed", wave, turned_round(below)});
    out.push_back({"both sides of a parabola", lens, path_from("M 2 0 Q 1 2 0 0 L 0 3 L 2 3 Z")});
    out.push_back({"a parabola and its halves", lens, path_from("M 0 0 Q 0.5 1 1 1 Q 1.5 1 2 0 Z")});
    out.push_back(
        {"a parabola as a cubic", path_from("M 0 0 Q 1.5 3 3 0 Z"), path_from("M 0 0 C 1 2 2 2 3 0 Z")});
}

inline void add_cusps(NastyPairs& out) {
    const Path cusp = path_from("M 0 0 C 4 4 0 4 4 0 Z"), mirrored = path_from("M 0 6 C 4 2 0 2 4 6 Z");
    out.push_back({"tip to tip", cusp, mirrored});
    out.push_back({"an edge through the tip", cusp, {{rectangle(0, 3, 4, 5)}}});
    out.push_back({"a corner in the tip", cusp, path_from("M 2 3 L 5 3 L 5 5 Z")});
    out.push_back({"the axis of a cusp", cusp, {{rectangle(2, -1, 5, 5)}}});
    out.push_back({"a cusp and itself reversed", cusp, turned_round(cusp)});
    out.push_back({"a circle through the tip", cusp, disc_at(2, 2, 1)});
}

inline void add_slivers(NastyPairs& out) {
    const Path square{{rectangle(0, 0, 1, 1)}};
    for (const double h : {1e-12, 1e-9, 1e-6}) {
        out.push_back({"a thin triangle", square, {{polygon({{{0.25, 1}}, {{0.75, 1}}, {{0.5, 1 + h}}})}}});
        out.push_back({"a thin rectangle across", square, {{rectangle(-1, 0.5, 2, 0.5 + h)}}});
        out.push_back({"overlap by little", square, {{rectangle(1 - h, 0, 2, 1)}}});
        out.push_back({"turned by little", square, moved(square, h, 1, {})});
    }
    out.push_back({"thin against thin", {{rectangle(0, 0, 1, 1e-12)}}, {{rectangle(0, 0, 1e-12, 1)}}});
}

inline void add_nests(NastyPairs& out) {
    Path rings, boxes, even, odd, few_rings, few_boxes;
    for (int i = 1; i <= 50; ++i) {
        const Path disc = disc_at(0, 0, i), box{{rectangle(-i, -i, i, i)}};
        rings = both(std::move(rings), i % 2 ? disc : turned_round(disc));
        boxes = both(std::move(boxes), box);
        (i % 2 ? odd : even) = both(std::move(i % 2 ? odd : even), box);
        if (i == 8) few_rings = rings, few_boxes = boxes;
    }
    out.push_back({"even and odd boxes", even, odd});
    out.push_back({"boxes and their like", boxes, boxes});
    out.push_back({"rings, there and back", rings, turned_round(rings)});
    out.push_back({"rings and a box through the middle", rings, {{rectangle(0, 0, 60, 60)}}});
    out.push_back({"rings in boxes that they touch", few_rings, few_boxes});
}

inline void add_stars(NastyPairs& out) {
    for (const int n : {5, 7, 9, 11}) {
        const Path star = star_polygon(n, n / 2);
        out.push_back({"a star, turned by half a step", star, star_polygon(n, n / 2, std::numbers::pi / n)});
        out.push_back({"a star and its hull", star, star_polygon(n, 1)});
        out.push_back({"a star on a circle", star, disc_at(0, 0, 3)});
    }
}

inline void add_degenerate_segments(NastyPairs& out) {
    const Path square{{rectangle(0, 0, 2, 2)}};
    for (const char* data :
         {"M 0 0 L 0 0 L 2 0 L 2 0 L 2 2 L 0 2 Z", "M 1 1 C 1 1 1 1 1 1 L 3 1 L 3 3 Z",
          "M 0 0 C 5 0 -3 0 2 0 L 2 2 L 0 2 Z", "M 0 0 Q 7 0 2 0 L 1 2 Z", "M 0 0 C 0 0 2 2 2 2 L 0 2 Z",
          "M 0 0 C 0 0 0 0 2 1 C 2 1 2 3 0 2 Z", "M 0 0 L 2 2 L 0 0 L 2 0 L 0 0 Z", "M 1 -1 L 1 3 L 1 -1 Z"})
        out.push_back({data, square, path_from(data)});
}

inline void add_huge_ones(NastyPairs& out) {
    const double far = 1e12;
    out.push_back({"far squares",
                   {{rectangle(far, far, far + 100, far + 100)}},
                   {{rectangle(far + 100, far, far + 200, far + 50)}},
                   1});
    out.push_back({"far circles", disc_at(far, -far, 100), disc_at(far + 100, -far, 100), 1});
    out.push_back({"far circles that touch", disc_at(far, far, 100), disc_at(far + 200, far, 100), 1});
    out.push_back({"small in huge", {{rectangle(-far, -far, far, far)}}, disc_at(0, 0, 10), 1});
    out.push_back({"far stars", moved(star_polygon(5, 2, 0, 300), 0, 1, {{far, 0}}),
                   moved(star_polygon(7, 3, 0, 300), 0, 1, {{far, 0}}), 1});
}

inline void add_open_ones(NastyPairs& out) {
    const Path square{{rectangle(0, 0, 2, 2)}}, dot{{Subpath{{{1, 1}}, {}, false}}},
        spot{{Subpath{{{1, 1}}, {}, true}}};
    out.push_back({"a dot", square, dot});
    out.push_back({"a closed dot", square, both(spot, square)});
    out.push_back({"two dots", dot, spot});
    out.push_back({"nothing", square, Path{}});
    for (const char* data :
         {"M 0 0 L 2 0 L 2 2", "M 0 1 L 2 1", "M 0 1 A 1 1 0 0 1 2 1", "M 0 0 C 4 4 -2 4 2 0",
          "M 0 0 L 2 2 M 2 0 L 0 2", "M 0 0 L 2 0 L 2 2 M 2 2 L 0 2 L 0 0"})
        out.push_back({data, square, path_from(data)});
}

inline void add_fans(NastyPairs& out) {
    Path fan, other, rosette;
    for (int i = 0; i < 12; ++i) {
        const double angle = std::numbers::pi / 6 * i, x = std::cos(angle), y = std::sin(angle);
        const Path blade{{polygon({{{0, 0}}, {{4 * x, 4 * y}}, {{4 * x - y, 4 * y + x}}})}};
        (i % 2 ? fan : other) = both(std::move(i % 2 ? fan : other), blade);
        rosette = both(std::move(rosette), disc_at(x, y, 1));
    }
    out.push_back({"blades around a point", fan, other});
    out.push_back({"circles through a point", rosette, disc_at(0, 0, 1)});
    out.push_back({"circles and blades", rosette, both(fan, other)});
}

inline NastyPairs nasty_pairs() {
    NastyPairs out;
    for (const auto add : {add_grids, add_tangent_circles, add_equal_arcs, add_cusps, add_slivers, add_nests,
                           add_stars, add_degenerate_segments, add_huge_ones, add_open_ones, add_fans})
        add(out);
    return out;
}

}  // namespace freiform::test
