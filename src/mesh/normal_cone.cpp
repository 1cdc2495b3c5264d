// Bending (bending.cpp) proves |N - n| <= tilt over a box, for unit vectors N and n: an angle of 2 asin(tilt
// / 2).
//
// Where S_d jumps by at most J across lines inside the box, n . S_d does so too, and |DS d| may be less by as
// much: with j = |(J_u / a, J_v / b)| / least the turn of bending.cpp becomes (turn + j) / (1 - j). So the
// knots of rational circles, whose jumps are rounding, do no harm.
//
// A box about a triangle is twice as large as the triangle, so it is cut in four once if that brings the
// parts that meet the triangle nearer. The angle between a triangle's normal m and N is at most that between
// m and n and the angle of the cone.
//
// Accuracy. m is a cross product of differences of doubles: each component is off by at most 4 2^-52 |d| |e|
// (two products of factors with errors 2^-53, and a difference), |m| by less than 7 2^-52 |d| |e|, and its
// direction by the asin of that over |m|. n is off by some 2^-51, acos is not used where it is steep (atan2
// of |m x n| and m . n); 1e-12 covers both and the rest.
#include "curvature_tree_detail.hpp"

#include <freiform/mesh/normal_cone.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWidth = 1.0 / 16;
constexpr double kResolved = 2.1e9;  // twice what bending_of asks for half of a side
constexpr double kRoundedJump = 1e-9;
constexpr double kCrossError = 7 * 0x1p-52, kAngleError = 1e-12;

// The jumps of the first derivative along the axis inside the box: a bound of their sum.
double jumps_inside(const DerivativeQuery<2, 3>& surface, const Box<2>& box, int axis) {
    double sum = 0;
    for (const Kink& k : surface.kinks(axis))
        if (box.lo[axis] < k.at && k.at < box.hi[axis]) sum += k.jump;
    return sum;
}

// First derivatives over a very small box are all rounding (bending.cpp); over a larger one they are not, and
// normals turn little more. Not over kinks that are more than rounding, nor beyond the ends of splines.
Box<2> widened(const DerivativeQuery<2, 3>& surface, Box<2> box) {
    const auto j = jet<1>(surface.geometry(), {box.side(0).middle(), box.side(1).middle()});
    const auto ends = limits(surface.geometry());
    const double resolved = kResolved * surface.value_error({box.side(0), box.side(1)});
    for (int axis = 0; axis < 2; ++axis) {
        const double own = norm(j.d[std::size_t(1 + axis)]), other = norm(j.d[std::size_t(2 - axis)]);
        const double width = std::max(kWidth * box.side(1 - axis).length() * other, resolved) / own;
        const double more = (width - box.side(axis).length()) / 2;
        if (!(more > 0) || !std::isfinite(more)) continue;
        const Interval end = ends[std::size_t(axis)];
        double least = std::min(box.lo[axis], end.lo), most = std::max(box.hi[axis], end.hi);
        for (const Kink& k : surface.kinks(axis)) {
            if (k.jump <= kRoundedJump * own) continue;
            if (k.at <= box.lo[axis]) least = std::max(least, k.at);
            if (k.at >= box.hi[axis]) most = std::min(most, k.at);
        }
        // What there is no room for on one side is had on the other.
        const double lo = std::max(box.lo[axis] - more, least), hi = std::min(box.hi[axis] + more, most);
        const double missing = resolved / own - (hi - lo);
        if (missing > 0 && lo == least)
            box.lo[axis] = lo, box.hi[axis] = std::min(hi + missing, most);
        else
            box.lo[axis] = missing > 0 ? std::max(lo - missing, least) : lo, box.hi[axis] = hi;
    }
    return box;
}

// Scaled by a power of two, so that products neither overflow nor vanish.
Vec<3> near_one(const Vec<3>& v) {
    const double m = max_abs(v);
    if (!(m > 0) || !std::isfinite(m)) return v;
    const int e = std::ilogb(m);
    return {{std::scalbn(v[0], -e), std::scalbn(v[1], -e), std::scalbn(v[2], -e)}};
}

double angle_between(const Vec<3>& a, const Vec<3>& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

// Not wholly on one outer side of the triangle; counter-clockwise. Rounding only keeps boxes that could go.
bool may_meet(const Box<2>& box, const std::array<Vec<2>, 3>& t) {
    const double slack = 1e-12 * box.scale();
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec<2>&a = t[k], d = t[(k + 1) % 3] - t[k];
        double most = -1;
        for (int corner = 0; corner < 4; ++corner) {
            const Vec<2> p{{corner & 1 ? box.hi[0] : box.lo[0], corner & 2 ? box.hi[1] : box.lo[1]}};
            most = std::max(most, cross(d, p - a) + slack * (std::abs(d[0]) + std::abs(d[1])));
        }
        if (most < 0) return false;
    }
    return true;
}

}  // namespace

NormalCone normal_cone(const DerivativeQuery<2, 3>& surface, const Box<2>& box) {
    const Box<2> around = widened(surface, box);
    const Bending at = bending_of(surface, around, true);
    if (!(at.least > 0)) return {at.n, kPi};
    const double jump =
        std::hypot(jumps_inside(surface, around, 0) / at.a, jumps_inside(surface, around, 1) / at.b) /
        at.least * (1 + 1e-9);
    const double tilt = (at.tilt + kChord * jump) / (1 - jump);
    if (!(jump < 0.5) || !(tilt <= kChord * kMostTurn)) return {at.n, kPi};
    return {at.n, std::min(kPi, 2 * std::asin(tilt / 2) + kAngleError)};
}

bool has_narrow_cones(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double angle) {
    constexpr double kSmall = 0x1p-20;  // of the box, or what rounding leaves room for
    const Vec<2> sides = box.hi - box.lo;
    for (const double part : {0.41, 0.27}) {  // beside the middle, where knots are
        const Vec<2> at = box.lo + part * sides;
        if (normal_cone(surface, {at, at + kSmall * sides}).angle <= angle) return true;
    }
    return false;
}

double normal_angle_bound(const DerivativeQuery<2, 3>& surface, const std::array<Vec<2>, 3>& uv,
                          const std::array<Vec<3>, 3>& corners) {
    const Vec<3> d = near_one(corners[1] - corners[0]), e = near_one(corners[2] - corners[0]);
    const Vec<3> m = cross(d, e);
    const double turned = kCrossError * norm(d) * norm(e) / norm(m);
    if (!(turned < 0.5)) return kPi;
    const double own = 1.1 * turned + kAngleError;
    Box<2> box;
    for (const Vec<2>& p : uv) box.add(p);
    const auto angle = [&](const Box<2>& b) {
        const NormalCone cone = normal_cone(surface, b);
        return cone.angle < kPi ? std::min(kPi, angle_between(m, cone.axis) + cone.angle + own) : kPi;
    };
    const double whole = angle(box);
    double parts = 0;
    const Vec<2> middle = 0.5 * (box.lo + box.hi);
    for (int i = 0; i < 4 && parts < whole; ++i) {
        Box<2> part = box;
        for (int axis = 0; axis < 2; ++axis) (i >> axis & 1 ? part.lo : part.hi)[axis] = middle[axis];
        if (may_meet(part, uv)) parts = std::max(parts, angle(part));
    }
    return std::min(whole, parts);
}

}  // namespace freiform
