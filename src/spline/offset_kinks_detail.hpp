// Where first derivatives of offsets jump though their base has continuous ones.
//
// Idea. The normal n of a surface S turns with its second derivatives: along the axis a, n_a is the vector x
// of the tangent plane with x . S_a = - n . S_aa and x . S_b = - n . S_ab. Where S_aa jumps, at a knot across
// which S has one continuous derivative, and S_ab does not, n_a jumps by the vector with the parts - n .
// [S_aa] and 0: by |n . [S_aa]| |S_b| / |S_a x S_b|. What S_aa jumps by along S counts for nothing.
//
// Accuracy. The jump is taken between two places beside the line, which adds what S_aa changes by from there
// to the line, and at the middle of a part of the line, which adds what n and S_aa change by along the part:
// bounds of third derivatives on both sides. Where parameters are too large beside the pieces for two places
// that are distinct and within them, nothing is known.
#pragma once
#include "swept_bounds_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace freiform::detail {

constexpr double kBesideLine = 0x1p-20;  // of the thinnest piece
constexpr double kDistinct = 0x1p-50;    // of a parameter: others are this far from it at least
constexpr int kMostParts = 64;           // of a line
constexpr double kEnough = 1.25;         // times what is seen

// What the normal's first derivative jumps by over a part of a line: a bound, infinite where the normal may
// vanish, and what is seen in the middle.
struct NormalJump {
    double bound = kInfinity, seen = 0;
    Interval part;
    bool operator<(const NormalJump& other) const { return bound < other.bound; }
};

// Of the line at `at` across `axis`; `rounding`: of second derivatives.
inline NormalJump jump_of_normal(const DerivativeQuery<2, 3>& base, int axis, double at, Interval part,
                                 double rounding) {
    const std::size_t a = std::size_t(axis), b = 1 - a;
    const double thinnest = base.thinnest_piece(axis),
                 step = std::max(kBesideLine * thinnest, kDistinct * std::abs(at));
    std::array<Interval, 2> box;
    box[a] = {at - step, at + step}, box[b] = part;
    const double beside = std::max(at - box[a].lo, box[a].hi - at);  // exact
    if (!(beside < thinnest / 2)) return {kInfinity, 0, part};
    const NormalBounds n(base, box);
    if (!(n.least > 0)) return {kInfinity, 0, part};
    const auto& S = n.all.d;
    const std::size_t second = a == 0 ? 3 : 5, third = a == 0 ? 6 : 9, along = a == 0 ? 7 : 8;
    const auto sample = [&](double x) {
        std::array<double, 2> uv;
        uv[a] = x, uv[b] = part.middle();
        return jet<2>(base.geometry(), uv);
    };
    const auto before = sample(box[a].lo), after = sample(box[a].hi);
    const double jump = std::abs(dot(n.middle, after.d[second] - before.d[second]));
    const double most =
        jump + 2 * (beside * S[third] + n.half[b] * S[along] + rounding) + 2 * n.beside(n.middle) * S[second];
    return {(1 + 64 * kUnitRoundoff) * most * S[1 + b] / n.least,
            jump * norm(after.d[1 + b]) / norm(cross(after.d[1], after.d[2])), part};
}

// Along the whole line; infinite where no bound is found. The part with the largest bound is halved.
inline double largest_jump_of_normal(const DerivativeQuery<2, 3>& base, int axis, double at, Interval line,
                                     double rounding) {
    std::priority_queue<NormalJump> parts;
    double seen = 0;
    const auto add = [&](Interval part) {
        const NormalJump jump = jump_of_normal(base, axis, at, part, rounding);
        seen = std::max(seen, jump.seen);
        parts.push(jump);
    };
    add(line);
    while (line.length() > 0 && parts.size() < kMostParts && !(parts.top().bound <= kEnough * seen)) {
        const Interval part = parts.top().part;
        parts.pop();
        add({part.lo, part.middle()}), add({part.middle(), part.hi});
    }
    return parts.top().bound;
}

// Along the axis: where the base has a kink, its offset is torn; where it bends otherwise on both sides, the
// offset has a kink. `bends`: of the base, or of its profile, and `rounding` of its second derivatives.
inline std::vector<Kink> offset_kinks(const OffsetSurface& o, const DerivativeQuery<2, 3>& base, int axis,
                                      std::span<const double> bends, double rounding) {
    const bool is_swept = base.piece_numbers() == 0;  // then it is the same all along the line
    const Interval line = is_swept ? Interval{0, 0} : domain(base.geometry())[std::size_t(1 - axis)];
    std::vector<Kink> out;
    for (const Kink& k : base.kinks(axis)) out.push_back({k.at, kInfinity});
    for (std::size_t i = 1; i + 1 < bends.size(); ++i)
        if (std::ranges::find(base.kinks(axis), bends[i], &Kink::at) == base.kinks(axis).end())
            out.push_back({bends[i], std::abs(o.distance) *
                                         largest_jump_of_normal(base, axis, bends[i], line, rounding)});
    std::ranges::sort(out, {}, &Kink::at);
    return out;
}

}  // namespace freiform::detail
