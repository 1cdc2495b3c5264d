// Where two circles meet that go on from the sides of a corner: all tips that rounding leaves possible.
#pragma once
#include "arcs_join_detail.hpp"

#include <optional>

namespace freiform::detail {

using BoundedPoint = BoundedVec<2>;

// The circle of an edge: through e, |e| = 1, about (1 - 1 / l) e; a line for l = 0.
struct EdgeCircle {
    BoundedPoint e;
    Bounded l;
};
// Edges of curvatures below it count as straight where both are, or where circles grow until they touch; and
// sides as parallel whose cosine is nearer to -1.
inline constexpr double kStraightEdge = 0x1p-40;
EdgeCircle edge_circle(const JoinSide& side);

struct ArcsTip {
    std::optional<Vec<2>> at;  // none: the circles have nothing in common ahead of both sides
    double bound = 0;          // of the distance to the tip of the exact circles; infinite: perhaps there is
                               // one where there is none here, or the other way round
    bool apart = false;        // of `none`: surely because of circles that are apart, on parallel sides
};
ArcsTip arcs_tip(const JoinSide& first, const JoinSide& last);

}  // namespace freiform::detail
