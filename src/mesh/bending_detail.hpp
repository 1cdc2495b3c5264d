// What bounds of second derivatives are made of: bending.cpp.
#pragma once
#include "curvature_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform {

inline constexpr double kBendingRounding = 1e-6;  // of a, b and n, with room
inline constexpr double kSumSlack = 1 + 0x1p-46;  // more than the roundings of sums of a few terms

// Of the box, from the middle, which is rounded, to the ends.
inline Vec<2> half_sides(const std::array<Interval, 2>& on) {
    const auto half = [](const Interval& x) {
        return x.length() / 2 + 2 * kUnitRoundoff * std::max(std::abs(x.lo), std::abs(x.hi));
    };
    return {{half(on[0]), half(on[1])}};
}

// What second derivatives change by from the middle, by third ones; with their own error `slip`.
inline Curvature change_by(const Vec<2>& half, const std::array<double, 4>& third, const Curvature& slip) {
    return {(half[0] * third[0] + half[1] * third[1] + slip.uu) * kSumSlack,
            (half[0] * third[1] + half[1] * third[2] + slip.uv) * kSumSlack,
            (half[0] * third[2] + half[1] * third[3] + slip.vv) * kSumSlack};
}

// The normal of the tangents u and v in the middle of the box, where rounding leaves one.
std::optional<Vec<3>> normal_in(const DerivativeQuery<2, 3>& surface, const std::array<Interval, 2>& on,
                                const Vec<3>& u, const Vec<3>& v);
// What makes parameters lengths, and how steady the normal is: from the tangents u, v and the normal n in the
// middle, and `along` and `beside`, bounds of the second derivatives of n . S and of the rest of S.
void add_normals(BoxBending& out, const std::array<Interval, 2>& on, const Vec<3>& u, const Vec<3>& v,
                 const Vec<3>& n, const Curvature& along, const Curvature& beside);

}  // namespace freiform
