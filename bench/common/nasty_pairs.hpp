// Pairs of surfaces on which intersections are known to hang, to fill memory or to say nothing: they touch,
// overlap, nearly do, or are singular where they meet.
#pragma once
#include <freiform/make/quadric.hpp>

#include <string>
#include <vector>

namespace freiform::bench {

struct NastyPair {
    std::string name;  // one word
    Surface<Hom<3>> a, b;
};

inline Surface<Hom<3>> nasty_cylinder(const Vec<3>& origin, const Vec<3>& axis, double r, double half,
                                      const Vec<3>& toward = {}) {
    return cylinder(*frame_about(origin, axis, toward), r, {-half, half})->surface;
}
inline Surface<Hom<3>> nasty_board(const Vec<3>& o, const Vec<3>& u, const Vec<3>& v) {
    const auto b = *BSplineBasis::bezier(1, {0, 1});
    return to_rational(*Surface<Vec<3>>::make({b, b}, Net<2, Vec<3>>({2, 2}, {o, o + v, o + u, o + u + v})));
}
inline Surface<Hom<3>> lifted_by(const Surface<Hom<3>>& s, double height) {
    auto net = s.net();
    for (Hom<3>& h : net.flat()) h[2] += height * h.weight();
    return *Surface<Hom<3>>::make(s.bases(), net);
}

// `hills`: a landscape over the unit square.
inline std::vector<NastyPair> nasty_pairs(const Surface<Hom<3>>& hills) {
    const Vec<3> o{}, z{{0, 0, 1}};
    const auto tube = nasty_cylinder(o, z, 1, 2);
    const auto ball = sphere(*frame_about(o, z), 1)->surface,
               tilted = sphere(*frame_about(o, {{1, 2, 3}}), 1)->surface;
    const auto ring = torus(*frame_about(o, z), 2, 0.5)->surface;
    const auto tip = cone(*frame_about(o, z), 1, 0, {0, 1})->surface;
    const auto beside = [](double d) {
        return nasty_board({{1 + d, -2, -2.5}}, {{0, 4.1, 0}}, {{0, 0, 5.2}});
    };
    const auto part = *restrict_to(*restrict_to(hills, 0, {0.2, 0.7}), 1, {0.1, 0.9});
    return {{"plane_touches_cylinder", tube, beside(0)},
            {"plane_1e-9_inside_cylinder", tube, beside(-1e-9)},
            {"plane_1e-9_beside_cylinder", tube, beside(1e-9)},
            {"cylinders_touch", tube, nasty_cylinder({{2.5, 0, 0.25}}, z, 1.5, 2)},
            {"cylinder_in_cylinder", tube, nasty_cylinder({{0.5, 0, 0.25}}, z, 0.5, 1)},
            {"ball_in_cylinder", ball, tube},
            {"tilted_ball_in_cylinder", tilted, tube},
            {"torus_on_plane", ring, nasty_board({{-3, -3.1, 0.5}}, {{6.2, 0, 0}}, {{0, 6.3, 0}})},
            {"equal_cylinders_cross", tube, nasty_cylinder(o, {{1, 0, 0}}, 1, 2)},
            {"balls_touch", ball, sphere(*frame_about({{1.2, 1.6, 0}}, {{1, 2, 3}}), 1)->surface},
            {"same_ball_tilted", ball, tilted},
            {"same_cylinder_turned", tube, nasty_cylinder({{0, 0, 0.5}}, z, 1, 1.5, {{1, 1, 0}})},
            {"same_plane_turned", nasty_board(o, {{1, 0, 0}}, {{0, 1, 0}}),
             nasty_board({{0.5, 0, 0}}, {{1, 1, 0}}, {{-1, 1, 0}})},
            {"hills_and_a_part", hills, part},
            {"hills_raised", hills, *elevate(*elevate(hills, 0), 1)},
            {"hills_lifted_by_1e-7", hills, lifted_by(hills, 1e-7)},
            {"hills_lifted_by_1e-5", hills, lifted_by(hills, 1e-5)},
            {"plane_through_apex", tip, nasty_board({{0, -2, -1}}, {{0, 0, 3}}, {{0, 4, 0}})},
            {"plane_on_apex", tip, nasty_board({{-2, -2, 1}}, {{4, 0, 0}}, {{0, 4, 0}})}};
}

}  // namespace freiform::bench
