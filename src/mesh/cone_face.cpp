// Why triangles of a cone may be as long as its lines.
//
// Notation: S(u, v) = y c(u) with the apex as origin, y = y(v) >= 0 linear in v, 1 at the far end of the
// face; M >= |c''|, which is |S_uu| at the far end; a triangle with the corners (u_i, y_i), barycentric
// coordinates l_i, k_i = l_i y_i.
//
// Its point sum l_i S(u_i, y_i) = sum k_i c(u_i) is compared with the surface at Y = sum k_i, U = sum k_i u_i
// / Y. By Taylor's formula about U, whose linear part sums up to nothing,
//     |sum k_i c(u_i) - Y c(U)| <= M/2 sum k_i (u_i - U)^2 = M/2 min over u of sum k_i (u_i - u)^2,
// which is at most M/2 max_i y_i (u_i - u)^2 for any u. The best u makes it M/2 times the largest of
//     (u_i - u_j)^2 / (1 / sqrt(y_i) + 1 / sqrt(y_j))^2,
// as intervals on a line that meet pairwise have a point in common. Chords of circles at two heights that
// keep a tolerance are joined by triangles that keep it: what is seen of S_uv, which a plane parameter
// triangle has to count, is not there. A kink of c adds what it adds to chords. Rounding: heights are off by
// what v and the parameter of the apex are; they are made larger by that. Surfaces that are cones but for a
// slip: it is a multiple between 0 and 1 of one vector for each u, so against the c of the far end it is no
// more, once for the corners and once for the place on the surface.
//
// Nothing is left out. (u, v) -> (u y, y) makes S linear on lines through the origin, and the triangle above
// is straight there: it is a triangulation of the same boundary with other sides between the same points. The
// argument of bending.cpp holds with G(u, v) = (U, v), as plain vertices need no foot. Sides along parameter
// lines are the same in both. Another side from (u_0, y_0) to (u_1, y_1) bows: at equal l it is off by
//     |u_1 - u_0| l_0 l_1 |y_1 - y_0| / Y <= |u_1 - u_0| |sqrt(y_1) - sqrt(y_0)| / (sqrt(y_1) + sqrt(y_0))
// across, and at the boundary what is between counts as a sliver (edge_error.cpp). Turned over: a triangle is
// one in space as its corners (u y, y) are, which those of long thin ones at bowed sides need not be as
// their parameters are.
//
// Spheres, S(u, v) = A(v) + h(v) c(u) with A on the axis and c a circle of radius 1, are compared likewise:
// with U and V = sum l_i v_i, k_i = l_i h(v_i). Its centre as origin, a point p of the triangle is R - |p| <=
// R - N . p from the sphere, N the normal at (U, V). As N . S(U, V) = R, that is N . (S(U, V) - p): of the
// circles cos s (sum k_i - sum k_i cos(u_i - U)) <= cos s / 2 sum k_i (u_i - U)^2, cos s = h(V) / R, and of
// the profile R (1 - sum l_i cos(v_i - V)) <= R/2 sum l_i (v_i - V)^2. So with M = h / R for the largest h,
// and R for what is along, the distance is at most half of the largest h_i M (u_i - u)^2 + R (v_i - v)^2 for
// any (u, v), here middles of sides and of the circle through the corners. Around poles that asks for a fan
// where feet (q in bending.cpp) ask for ever smaller triangles. Nothing is left out: let G be the projection
// of L from the centre. Triangles that keep to R / 8 are smaller than R, so that nowhere G is opposite to S,
// and the degree of G is that of S. Corners a little beyond a pole, b from the axis, count as at it: they are
// less than 2 b away, and so is what the surface has there; with the (V - v)^2 of middles 5 b are added. On
// the boundary a point first goes along its side to the one y' with S(y') above L (edge_error.cpp), which is
// within E of L, then along a great circle to G, which is within e; between them the distance is at most that
// of the farther one and (E + e)^2 / (8 R), which counts as a sliver.
//
// Why not by what is seen along normals: S_uv / |S_u| is 1 / y, so feet near the apex have to be looked for
// in parts of the height there. Why not developed into the plane: the curves of trims would have to follow.
#include "cone_face_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/chord_triangles.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kGrow = 1 + 1e-12;
constexpr double kBeyondApex = 0x1p-36;  // of the height of the face
constexpr double kBeyondPole = 0x1p-28;  // of the radius: what files with ten digits of an angle have
constexpr int kSamples = 9;
constexpr double kLessThanTurn = 3.2;  // from pole to pole, with roundings
constexpr double kWorth = 0.25;        // of second derivatives, what bends lines across: edges need as much
constexpr double kStraight = 1e-3;     // of a way, what its first derivative varies by

bool is_on_one_side(const Apex& apex, const Box<2>& face) {
    const Interval on = face.side(apex.ruled);
    const double before = apex.at - on.lo, behind = on.hi - apex.at, height = std::max(before, behind);
    return height > 0 && std::min(before, behind) <= kBeyondApex * height;
}

// From the axis.
double height_of(const Revolution& s, const Apex& apex, double v) {
    const Vec<3> p = jet<0>(s.profile, v).value();
    return dot(p - s.origin, apex.outwards) + 32 * kUnitRoundoff * (norm(p) + norm(s.origin));
}

}  // namespace

std::optional<ConeFace> ConeFace::make(const Apex& apex, const DerivativeQuery<2, 3>& surface,
                                       const Box<2>& face) {
    if (const Interval used = face.side(apex.ruled); used.lo < apex.part.lo || used.hi > apex.part.hi)
        return std::nullopt;
    ConeFace out;
    out.apex_ = apex;
    out.slip_ = 2 * apex.slip;  // of corners, and of what they are compared with
    if (apex.radius > 0) {
        out.sphere_ = std::get_if<Revolution>(&surface.geometry());
        const Interval on = face.side(1);
        for (const double v : {on.lo, on.hi})
            out.beyond_ = std::max(out.beyond_, -height_of(*out.sphere_, apex, v));
        if (!(out.beyond_ <= kBeyondPole * apex.radius)) return std::nullopt;
        out.slip_ += 5 * out.beyond_;
        return out;
    }
    if (!is_on_one_side(apex, face)) return std::nullopt;
    const Interval on = face.side(apex.ruled);
    const double before = apex.at - on.lo, behind = on.hi - apex.at;
    const double beyond = std::max(0.0, std::min(before, behind));
    out.far_ = behind >= before ? on.hi : on.lo;
    if (beyond > 0) out.slip_ += 2 * beyond * out.bends(surface, face).first[apex.ruled];
    return out;
}

ConeFace::Bends ConeFace::bends(const DerivativeQuery<2, 3>& surface, const Box<2>& box) const {
    std::array<Interval, 2> on{box.side(0), box.side(1)};
    if (!sphere_) on[std::size_t(ruled())] = {far_, far_};
    const auto over = surface(on);
    Bends out{over(2, 0), over(0, 2), {over(1, 0), over(0, 1)}};
    if (ruled() == 0) std::swap(out.across, out.along);
    if (!sphere_) {
        out.along = 0;
        return out;
    }
    // Lines across are as high as at one end, but for what the profile bends between.
    const double length = on[1].length();
    const double highest =
        std::max(height_of(*sphere_, apex_, on[1].lo), height_of(*sphere_, apex_, on[1].hi));
    out.across = std::max(0.0, std::min(out.across, highest + out.along * (length * length / 8) * kGrow));
    out.across *= seen_across(out.across);
    return out;
}

double ConeFace::height(const Vec<2>& p) const {
    if (sphere_) {
        const double h = height_of(*sphere_, apex_, p[1]);
        return h < 0 && h >= -beyond_ ? 0 : h;
    }
    if (std::isinf(apex_.at)) return 1;
    const double v = p[ruled()], whole = far_ - apex_.at;
    const double off = 4 * kUnitRoundoff * (std::abs(v) + std::abs(apex_.at) + std::abs(far_));
    return std::clamp(((v - apex_.at) + std::copysign(off, whole)) / whole, 0.0, 1.0);
}

// Of second derivatives across, where lines are as high as this: all, but of spheres.
double ConeFace::seen_across(double highest) const {
    return apex_.radius > 0 ? std::min(1.0, highest / apex_.radius * kGrow) : 1;
}

double ConeFace::error(const Bends& bends, const std::array<Vec<2>, 3>& corner) const {
    std::array<double, 3> height, root;
    for (std::size_t i = 0; i < 3; ++i) {
        height[i] = this->height(corner[i]);
        if (!(height[i] >= 0)) return kInfinity;
        root[i] = std::sqrt(height[i]);
    }
    double across_bend = bends.across;
    if (sphere_) {
        const auto [lo, hi] = std::minmax({corner[0][1], corner[1][1], corner[2][1]});
        across_bend = seen_across(std::max({height[0], height[1], height[2]}) +
                                  bends.along * ((hi - lo) * (hi - lo) / 8));
    }
    const auto reach = [&](double u, double v) {
        double most = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double x = corner[i][across()] - u, y = corner[i][ruled()] - v;
            const double along = bends.along > 0 ? bends.along * y * y : 0;
            most = std::max(most, (height[i] > 0 ? across_bend * height[i] * x * x : 0) + along);
        }
        return most;
    };
    double best = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t k = (i + 1) % 3;
        const Vec<2>&p = corner[i], &q = corner[k];
        const double sum = root[i] + root[k], part = sum > 0 ? root[k] / sum : 0.5;
        best = std::min(best, reach(p[across()] + part * (q - p)[across()], 0.5 * (p + q)[ruled()]));
    }
    // The middle of the circle through the corners, all as high as the highest.
    const double scale_x = std::sqrt(across_bend) * std::max({root[0], root[1], root[2]}),
                 scale_y = std::sqrt(bends.along);
    const auto scaled = [&](const Vec<2>& d) {
        return Vec<2>{{scale_x * d[across()], scale_y * d[ruled()]}};
    };
    const Vec<2> a = scaled(corner[1] - corner[0]), b = scaled(corner[2] - corner[0]);
    const double twice = 2 * cross(a, b), aa = dot(a, a), bb = dot(b, b);
    const Vec<2> centre{{(aa * b[1] - bb * a[1]) / twice, (bb * a[0] - aa * b[0]) / twice}};
    if (std::isfinite(centre[0] + centre[1]) && scale_x * scale_y > 0)
        best = std::min(
            best, reach(corner[0][across()] + centre[0] / scale_x, corner[0][ruled()] + centre[1] / scale_y));
    return best / 2 * kGrow + slip_;
}

double ConeFace::bow(const Vec<2>& from, const Vec<2>& to) const {
    const double a = std::sqrt(std::max(0.0, height(from))), b = std::sqrt(std::max(0.0, height(to)));
    const double width = std::abs((to - from)[across()]);
    return a + b > 0 ? width * (std::abs(a - b) / (a + b)) * kGrow : width;
}

bool ConeFace::is_turned_over(const std::array<Vec<2>, 3>& corner) const {
    std::array<Vec<2>, 3> plain, developed;
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = (corner[i] - corner[0])[across()], y = corner[i][ruled()];
        plain[i] = {{x, y}};
        developed[i] = {{x * height(corner[i]), y}};
    }
    const double before = cross(plain[1] - plain[0], plain[2] - plain[0]),
                 behind = cross(developed[1] - developed[0], developed[2] - developed[0]);
    return (before < 0 && behind > 0) || (before > 0 && behind < 0);
}

bool is_worth_a_cone(const Apex& apex, const SurfaceGeometry& surface, const Box<2>& face) {
    const Interval lines = face.side(apex.ruled), on = face.side(1 - apex.ruled);
    if (apex.radius > 0) {
        const auto& s = std::get<Revolution>(surface);
        return std::min(height_of(s, apex, lines.lo), height_of(s, apex, lines.hi)) >=
                   -kBeyondPole * apex.radius &&
               height_of(s, apex, lines.middle()) > 0 && lines.length() < kLessThanTurn;
    }
    if (!is_on_one_side(apex, face)) return false;
    const double far = lines.hi - apex.at >= apex.at - lines.lo ? lines.hi : lines.lo;
    double seen = 0, all = 0, way = 0;
    for (int k = 0; k < kSamples; ++k) {
        std::array<double, 2> at{};
        at[std::size_t(apex.ruled)] = far;
        at[std::size_t(1 - apex.ruled)] = on.lo + (k + 0.5) / kSamples * on.length();
        const auto j = jet<2>(surface, at);
        const auto [first, second] =
            apex.ruled == 1 ? std::pair{j(1, 0), j(2, 0)} : std::pair{j(0, 1), j(0, 2)};
        if (norm(first) > 0) seen += norm(cross(unit(first), second));
        all += norm(second), way += norm(first);
    }
    // Of straight lines that run evenly, which are flat, second derivatives are what digits leave of them.
    return seen > kWorth * all || all * on.length() <= kStraight * way;
}

}  // namespace freiform
