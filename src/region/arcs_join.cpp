// The join `arcs`: up to where the circles of its sides meet, and what is cut off by the miter limit.
//
// Idea. Both sides of the outer edge go on along circles of their own curvature until these meet. Once the
// tip is known the circles are not asked for again: an arc is determined by its start, its direction there
// and its end. Lengths in half widths, the joint in the origin.
//
// Rules of SVG 2:
//   - both edges straight: miter-clip; an edge of curvature above 1: round;
//   - apart, with parallel sides: a rectangle as long as the limit;
//   - the length of the join is that of the arc from the joint to the tip which leaves along the bisector;
//     beyond the limit the join is cut off at right angles to that arc.
// Not in those rules: only points ahead of both sides, within half a turn, can be the tip; where there is
// none, the join is miter-clip. Where the line of the limit cuts off a side's own point, nothing is added to
// the triangle (bevel).
//
// Bound. Where a comparison that rounding leaves open chooses between joins that are not alike, it is
// infinite. Else, with a tip that is off by r:
//   - The points at a fraction s of the arc that leaves at an angle of p to its chord c, |p| <= pi / 2, are
//     |c| sin(s p) / sin(p) e^(isp). Their derivatives: by |c| at most 1; by p at most |c| times
//     sqrt(s^2 + (1 - s)^2 pi^2 / 4) <= pi / 2. So an arc is off by at most 2 r where its end is off by r.
//   - The length of the arc to the tip is off by 2 r, the place of the cut on it by 4 r, its direction by
//     9 r / |tip|: heights above the cut, of points within 1 + 2 |tip|, by less than 40 r (2 / pi < |tip|,
//     as it is longer than the limit). A side passes the cut between its heights of -40 r and 40 r.
//   - Both edges straight but for curvatures up to b: they deviate by b x^2 / 2 at the length x, and the tip,
//     at the miter m, by m times that.
//   - Parallel sides that are so up to an angle of a: circles that touch are as good as straight up to the
//     limit, which is a rectangle but for a times the limit.
// Sizes are multiplied by 2 to 16 for what the first order leaves out.
//
// References. SVG 2, section 13.5 ("Line joins").
#include "arcs_tip_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

// How much the edge is bent at most.
double bend_of(const JoinSide& side) {
    const Bounded l = edge_circle(side).l;
    return std::abs(l.value) + l.bound;
}

Vec<2> turned(const Vec<2>& v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{c * v[0] - s * v[1], s * v[0] + c * v[1]}};
}

// The line of the limit, through q across t, and by how much the height above it of a point is off.
struct Cut {
    Vec<2> q, t;
    double noise;
};

struct Passing {
    Vec<2> at;
    double bound;
};
// Where the arc from a side to the tip passes the line; the side is below it by more than the noise. As the
// arc turns by half a circle at most, it comes up through every height once, if it ends above.
Passing passing(const JoinSide& side, const Vec<2>& tip, const Cut& cut) {
    const auto at_height = [&](double height) {
        double lo = 0, hi = 1;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (lo + hi);
            (dot(on_arc(side.at, side.direction, tip, middle) - cut.q, cut.t) < height ? lo : hi) = middle;
        }
        return on_arc(side.at, side.direction, tip, lo);
    };
    const Vec<2> at = at_height(0), before = at_height(-cut.noise),
                 after = dot(tip - cut.q, cut.t) <= cut.noise ? tip : at_height(cut.noise);
    return {at, std::max(norm(at - before), norm(after - at))};
}

}  // namespace

double half_turn(const Vec<2>& at, const Vec<2>& direction, const Vec<2>& to) {
    return std::atan2(cross(direction, to - at), dot(direction, to - at));
}

Vec<2> on_arc(const Vec<2>& at, const Vec<2>& direction, const Vec<2>& to, double fraction) {
    const double whole = half_turn(at, direction, to);
    const double share = std::abs(whole) < 0x1p-30 ? fraction : std::sin(fraction * whole) / std::sin(whole);
    return at + share * norm(to - at) * turned(direction, fraction * whole);
}

ArcsJoin arcs_join(const JoinSide& first, const JoinSide& last, double limit) {
    const Bounded over_first = first.bend + Bounded(0.5), over_last = last.bend + Bounded(0.5);
    const auto surely_round = [](const Bounded& over) { return -over.value > over.bound; };
    if (surely_round(over_first) || surely_round(over_last)) return {ArcsJoinKind::round, {}, {}};
    const Vec<2> sum = first.at + last.at;
    if (!over_first.excludes_zero() || !over_last.excludes_zero())
        return {ArcsJoinKind::round, {}, {}, kInfinity};
    const double far = (1 + limit) * (1 + limit), bend = std::max(bend_of(first), bend_of(last));
    if (bend < kStraightEdge) {
        const double miter = std::min(2 / norm(sum), 1 + limit);
        return {ArcsJoinKind::miter_clip,
                {},
                {},
                bend == 0                   ? 0
                : norm(sum) < kStraightEdge ? kInfinity
                                            : 64 * bend * (far + miter * miter * miter)};
    }
    const ArcsTip found = arcs_tip(first, last);
    if (!found.at && dot(first.at, last.at) < -1 + kStraightEdge)
        return {ArcsJoinKind::arcs, first.at + limit * first.direction, last.at + limit * last.direction,
                found.bound + 4 * far * (std::abs(cross(first.at, last.at)) + 0x1p-48)};
    if (!found.at) return {ArcsJoinKind::miter_clip, {}, {}, found.bound};
    const Vec<2> tip = *found.at, middle = unit(sum + first.direction + last.direction);
    const double size = 1 + norm(tip), off = found.bound + 0x1p-46 * size, ahead = dot(middle, tip);
    if (!(std::abs(ahead) > off)) return {ArcsJoinKind::miter_clip, {}, {}, kInfinity};
    if (ahead < 0) return {ArcsJoinKind::miter_clip, {}, {}, found.bound};
    const double half = half_turn({}, middle, tip),
                 stretch = std::abs(half) < 0x1p-30 ? 1 : half / std::sin(half), length = norm(tip) * stretch,
                 length_off = 2 * off + 0x1p-44 * length;
    const double rounding = 0x1p-44 * size;
    if (length + length_off < limit) return {ArcsJoinKind::arcs, tip, tip, 2 * off + rounding};
    const double share = std::min(1.0, limit / length);
    const Cut cut{on_arc({}, middle, tip, share), turned(middle, 2 * half * share),
                  40 * off + length_off + rounding};
    const double above_first = dot(first.at - cut.q, cut.t), above_last = dot(last.at - cut.q, cut.t);
    if (above_first > cut.noise || above_last > cut.noise)
        return {ArcsJoinKind::arcs, first.at, last.at, rounding};
    if (!(above_first < -cut.noise && above_last < -cut.noise))
        return {ArcsJoinKind::arcs, first.at, last.at, kInfinity};
    const Passing x = passing(first, tip, cut), y = passing(last, tip, cut);
    const double bound = 2 * (std::max(x.bound, y.bound) + 2 * off) + rounding;
    if (length > limit) return {ArcsJoinKind::arcs, x.at, y.at, bound};
    return {ArcsJoinKind::arcs, tip, tip, bound + 2 * std::max(norm(tip - x.at), norm(tip - y.at))};
}

}  // namespace freiform::detail
