// The join `arcs`: two circles, where they meet, and what is cut off by the miter limit.
//
// Idea. Both sides of the outer edge go on along circles of their own curvature until these meet. Once the
// tip is known the circles are not asked for again: an arc is determined by its start, its direction there
// and its end.
//
// Notation. Lengths in half widths, the joint in the origin; e a side's point, |e| = 1; b the curvature of
// the path there, l = b / (1 + b) that of its edge, > 0 if the centre (1 - 1 / l) e is opposite to e. The
// circle is
//     l |x|^2 + 2 (1 - l) e . x = 2 - l,
// a line for l = 0. Two of them meet on the line g . x = l2 - l1 with g = l2 (1 - l1) e1 - l1 (1 - l2) e2.
//
// Rules of SVG 2 ("Line joins"; "Computing the circles", "Adjusting the circles"):
//   - both edges straight: miter-clip; an edge of curvature above 1: round;
//   - no point in common: both radii change by d until the circles touch, the larger one becoming smaller if
//     it encloses the other, both larger if they are apart; with a line only the circle changes. That the
//     centres are r1 -+ r2 apart is an equation of degree 2 in d, whose least root >= 0 is taken;
//   - apart, with parallel sides: a rectangle as long as the limit;
//   - the length of the join is that of the arc from the joint to the tip which leaves along the bisector;
//     beyond the limit the join is cut off at right angles to that arc.
// Of two points in common the one nearest to the joint is the tip. Not in those rules: only points ahead of
// both sides, within half a turn, can be the tip; where there is none, the join is miter-clip. Where the line
// of the limit cuts off a side's own point, nothing is added to the triangle (bevel).
//
// Accuracy. Some 50 operations on numbers up to 1 / l: as if the curvatures were off by some 2^-45 of
// themselves, and at most 2^-40, below which edges count as straight. What that does to a tip depends on the
// angle between the circles there.
//
// References. SVG 2, section 13.5.
#include "arcs_join_detail.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace freiform::detail {

namespace {

constexpr double kStraight = 0x1p-40;

struct EdgeCircle {
    Vec<2> e;
    double l;

    bool straight() const { return std::abs(l) < kStraight; }
    double radius() const { return 1 / std::abs(l); }
    // With a radius that is larger by d.
    Vec<2> centre(double d) const { return (1 - std::copysign(radius() + d, l)) * e; }
    Vec<2> shift() const { return std::copysign(1.0, -l) * e; }  // of the centre, for each unit of d
};

Vec<2> turned(const Vec<2>& v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{c * v[0] - s * v[1], s * v[0] + c * v[1]}};
}

bool is_ahead(const JoinSide& side, const Vec<2>& x) { return dot(side.direction, x - side.at) > -0x1p-40; }

// Of the roots of a x^2 + 2 b x + c.
std::vector<double> real_roots(double a, double b, double c) {
    const double d = b * b - a * c;
    if (!(d >= 0)) return {};
    const double q = -(b + std::copysign(std::sqrt(d), b));
    std::vector<double> roots;
    if (a != 0) roots.push_back(q / a);
    if (q != 0) roots.push_back(c / q);
    return roots;
}

std::vector<Vec<2>> common_points(const EdgeCircle& x, const EdgeCircle& y) {
    const Vec<2> g = y.l * (1 - x.l) * x.e - x.l * (1 - y.l) * y.e;
    const double square = dot(g, g);
    if (!(square > 0)) return {};
    const Vec<2> foot = ((y.l - x.l) / square) * g, along = unit(Vec<2>{{-g[1], g[0]}});
    const EdgeCircle& z = std::abs(x.l) < std::abs(y.l) ? y : x;
    std::vector<Vec<2>> points;
    for (const double s : real_roots(z.l, (1 - z.l) * dot(z.e, along),
                                     z.l * dot(foot, foot) + 2 * (1 - z.l) * dot(z.e, foot) - (2 - z.l)))
        points.push_back(foot + s * along);
    return points;
}

std::optional<Vec<2>> touching_line(const EdgeCircle& circle, const EdgeCircle& line) {
    const double m = dot(line.e, circle.centre(0)) - 1, side = std::copysign(1.0, m),
                 slope = 1 - side * dot(line.e, circle.shift());
    if (!(slope > 0x1p-40)) return {};
    const Vec<2> c = circle.centre((std::abs(m) - circle.radius()) / slope);
    return c - (dot(line.e, c) - 1) * line.e;
}

std::optional<Vec<2>> touching(const EdgeCircle& x, const EdgeCircle& y) {
    if (y.straight()) return touching_line(x, y);
    if (x.straight()) return touching_line(y, x);
    if (x.radius() < y.radius()) return touching(y, x);
    const Vec<2> between = y.centre(0) - x.centre(0);
    const bool apart = norm(between) >= x.radius();
    const double sign = apart ? 1 : -1, sum = x.radius() + sign * y.radius();
    const Vec<2> change = y.shift() - sign * x.shift();
    std::optional<double> least;
    for (const double d : real_roots(dot(change, change) - 4, dot(between, change) - 2 * sign * sum,
                                     dot(between, between) - sum * sum))
        if (d >= 0 && d < 0x1p40 && (apart || d <= sum) && (!least || d < *least)) least = d;
    if (!least) return {};
    const Vec<2> c = x.centre(sign * *least), toward = y.centre(*least) - c;
    if (max_abs(toward) == 0) return {};
    return c + (x.radius() + sign * *least) * unit(toward);
}

std::optional<Vec<2>> tip_of(const JoinSide& first, const JoinSide& last, const EdgeCircle& x,
                             const EdgeCircle& y) {
    std::optional<Vec<2>> tip;
    const auto consider = [&](const Vec<2>& p) {
        if (is_finite(p) && is_ahead(first, p) && is_ahead(last, p) && (!tip || dot(p, p) < dot(*tip, *tip)))
            tip = p;
    };
    const std::vector<Vec<2>> meetings = common_points(x, y);
    for (const Vec<2>& p : meetings) consider(p);
    if (meetings.empty())
        if (const auto p = touching(x, y)) consider(*p);
    return tip;
}

// Where the arc from a side to the tip passes the line through q across t; the side is before it.
Vec<2> passing(const JoinSide& side, const Vec<2>& tip, const Vec<2>& q, const Vec<2>& t) {
    double lo = 0, hi = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (lo + hi);
        (dot(on_arc(side.at, side.direction, tip, middle) - q, t) < 0 ? lo : hi) = middle;
    }
    return on_arc(side.at, side.direction, tip, lo);
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
    constexpr double kMostBend = -0.5;  // below it the edge is bent by more than 1
    if (first.bend < kMostBend || last.bend < kMostBend) return {ArcsJoinKind::round, {}, {}};
    const EdgeCircle x{first.at, first.bend / (1 + first.bend)}, y{last.at, last.bend / (1 + last.bend)};
    if (x.straight() && y.straight()) return {ArcsJoinKind::miter_clip, {}, {}};
    const Vec<2> middle = unit(first.at + last.at + first.direction + last.direction);
    const auto tip = tip_of(first, last, x, y);
    if (!tip && dot(first.at, last.at) < -1 + 0x1p-40)
        return {ArcsJoinKind::arcs, first.at + limit * first.direction, last.at + limit * last.direction};
    if (!tip || !(dot(middle, *tip) > 0)) return {ArcsJoinKind::miter_clip, {}, {}};
    const double half = half_turn({}, middle, *tip),
                 stretch = std::abs(half) < 0x1p-30 ? 1 : half / std::sin(half),
                 length = norm(*tip) * stretch;
    if (length <= limit) return {ArcsJoinKind::arcs, *tip, *tip};
    const Vec<2> q = on_arc({}, middle, *tip, limit / length), t = turned(middle, 2 * half * limit / length);
    if (!(dot(first.at - q, t) < 0 && dot(last.at - q, t) < 0))
        return {ArcsJoinKind::arcs, first.at, last.at};
    return {ArcsJoinKind::arcs, passing(first, *tip, q, t), passing(last, *tip, q, t)};
}

}  // namespace freiform::detail
