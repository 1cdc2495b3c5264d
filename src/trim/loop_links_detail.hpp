// All loops as links of one chain, for the check of loops.
#pragma once
#include "trim/chain_detail.hpp"

#include <freiform/query/self_intersection.hpp>
#include <freiform/trim/loops.hpp>

#include <cmath>
#include <optional>

namespace freiform::detail {

using Loop = std::vector<CurveGeometry<2>>;

struct Link {
    std::vector<Hom<2>> net;
    double error = 0;
    std::size_t loop = 0, curve = 0;
};
struct Links {
    std::vector<Link> link;       // link i is over [i, i + 1] of the parameter
    std::vector<Interval> loops;  // of the parameter, each; empty ones have lo == hi
    int exponent = 0;             // points of `link` are those given, times 2^-exponent: of size 1

    Vec<2> given(const Vec<2>& p) const {
        return {{std::scalbn(p[0], exponent), std::scalbn(p[1], exponent)}};
    }

    const Link& before(std::size_t joint) const {
        const Interval& on = loops[link[joint].loop];
        return link[double(joint) == on.lo ? std::size_t(on.hi) - 1 : joint - 1];
    }
};

// Refuses what chain_of refuses. `error`: every coordinate of every control point may be off by it.
Result<Links> links_of(std::span<const Loop> loops, double gap, double error = 0);

// check_loops, of loops whose control points may be off by `error`, for loops and copies of them: `shown[i]`
// is the loop that loops[i] is or was copied from. Refusals name those.
Result<void> check_copies(std::span<const Loop> loops, std::span<const std::size_t> shown,
                          const LoopTolerance& tolerance, double error);

// Where the chain meets itself, in the units of the links; parameters are those of the links.
Result<std::vector<SelfIntersection<2>>> meetings(const Links& all, double accuracy);

// A vertex in which the branches over both intervals cross: exact.
std::optional<Hom<2>> crossing_vertex(const Links& all, const Interval& first, const Interval& second);

// Contacts that are neither certain crossings nor exact ones in a vertex: which loops, and where on them.
struct LoopMeeting {
    std::array<std::size_t, 2> loop{};
    std::array<Interval, 2> on;
};
enum class Meets { undecided, crosses, touches };
// `crosses` and `touches` hold for all loops within the errors of the links; loop_sides.cpp says why.
// REQUIRES all places where the loops meet.
std::vector<Meets> how_they_meet(const Links& all, std::span<const Loop> loops, double gap,
                                 std::span<const LoopMeeting> found);

}  // namespace freiform::detail
