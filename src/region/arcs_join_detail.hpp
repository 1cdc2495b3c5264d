// The join `arcs` of SVG 2: where the circles end that go on with the curvature of the sides of a stroke.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/core/vec.hpp>

namespace freiform::detail {

// One side of the corner, with the joint in the origin and half the width of the pen as the unit of length.
struct JoinSide {
    Vec<2> at;         // of length 1
    Vec<2> direction;  // in which the side goes on; at right angles to `at`
    Bounded bend;      // curvature of the path there; > 0 where its centre is opposite to `at`
};
// Coordinates of `at` and `direction` may be off by this much.
inline constexpr double kJoinSideError = 0x1p-50;

enum class ArcsJoinKind { arcs, miter_clip, round };

// From the first side an arc with its direction there to `from_first`, a line to `from_last`, where the arc
// begins that ends in the last side with its direction. Each turns by half a circle at most. Nothing of this
// holds where the rules of SVG say miter_clip or round.
struct ArcsJoin {
    ArcsJoinKind kind = ArcsJoinKind::arcs;
    Vec<2> from_first, from_last;
    // The join that the rules give for the exact numbers is within this distance; infinite where rounding
    // leaves everything open.
    double bound = 0;
};

// Counter-clockwise from `first` to `last` on the outside of the corner; `first.at` is on the right of its
// direction. `limit` >= 1 is the miter limit.
ArcsJoin arcs_join(const JoinSide& first, const JoinSide& last, double limit);

// Half of what the arc turns by that leaves `at` in the unit direction and ends in `to`; > 0 to the left.
double half_turn(const Vec<2>& at, const Vec<2>& direction, const Vec<2>& to);
// The point of that arc at a fraction of its length.
Vec<2> on_arc(const Vec<2>& at, const Vec<2>& direction, const Vec<2>& to, double fraction);

}  // namespace freiform::detail
