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
// what v and the parameter of the apex are; they are made larger by that.
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
constexpr int kSamples = 5;
constexpr double kWorth = 0.25;  // of second derivatives, what is seen along the normal

}  // namespace

bool is_on_one_side(const Apex& apex, const Box<2>& face) {
    const Interval on = face.side(apex.ruled);
    const double before = apex.at - on.lo, behind = on.hi - apex.at, height = std::max(before, behind);
    return height > 0 && std::min(before, behind) <= kBeyondApex * height;
}

std::optional<ConeFace> ConeFace::make(const Apex& apex, const DerivativeQuery<2, 3>& surface,
                                       const Box<2>& face) {
    if (!is_on_one_side(apex, face)) return std::nullopt;
    const Interval on = face.side(apex.ruled);
    const double before = apex.at - on.lo, behind = on.hi - apex.at;
    const double beyond = std::max(0.0, std::min(before, behind));
    ConeFace out;
    out.ruled_ = apex.ruled;
    out.at_ = apex.at;
    out.far_ = behind >= before ? on.hi : on.lo;
    out.slip_ = 2 * apex.slip;  // of corners, and of what they are compared with
    if (beyond > 0) {
        const auto first = surface(out.far_end(face));
        out.slip_ += 2 * beyond * (apex.ruled == 0 ? first(1, 0) : first(0, 1));
    }
    return out;
}

std::array<Interval, 2> ConeFace::far_end(const Box<2>& box) const {
    std::array<Interval, 2> on{box.side(0), box.side(1)};
    on[std::size_t(ruled_)] = {far_, far_};
    return on;
}

double ConeFace::height(const Vec<2>& p) const {
    if (std::isinf(at_)) return 1;
    const double whole = far_ - at_;
    const double off = 4 * kUnitRoundoff * (std::abs(p[ruled_]) + std::abs(at_) + std::abs(far_));
    return std::clamp(((p[ruled_] - at_) + std::copysign(off, whole)) / whole, 0.0, 1.0);
}

double ConeFace::error(double bend, const std::array<Vec<2>, 3>& corner) const {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec<2>&p = corner[i], &q = corner[(i + 1) % 3];
        const double a = std::sqrt(height(p)), b = std::sqrt(height(q));
        if (!(a + b > 0)) continue;
        const double r = (p - q)[across()] * (a * b / (a + b));
        most = std::max(most, r * r);
    }
    return (most > 0 ? bend * most / 2 * kGrow : 0) + slip_;
}

double ConeFace::bow(const Vec<2>& from, const Vec<2>& to) const {
    const double a = std::sqrt(height(from)), b = std::sqrt(height(to));
    const double width = std::abs((to - from)[across()]);
    return a + b > 0 ? width * (std::abs(a - b) / (a + b)) * kGrow : width;
}

bool ConeFace::is_turned_over(const std::array<Vec<2>, 3>& corner) const {
    const auto twice_area = [](const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; };
    std::array<Vec<2>, 3> plain, developed;
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = (corner[i] - corner[0])[across()], y = height(corner[i]);
        plain[i] = {{x, y}};
        developed[i] = {{x * y, y}};
    }
    const double before = twice_area(plain[1] - plain[0], plain[2] - plain[0]),
                 behind = twice_area(developed[1] - developed[0], developed[2] - developed[0]);
    return (before < 0 && behind > 0) || (before > 0 && behind < 0);
}

bool is_worth_a_cone(const Apex& apex, const SurfaceGeometry& surface, const Box<2>& face) {
    const Interval lines = face.side(apex.ruled), on = face.side(1 - apex.ruled);
    const double far = lines.hi - apex.at >= apex.at - lines.lo ? lines.hi : lines.lo;
    double seen = 0, all = 0;
    for (int k = 0; k < kSamples; ++k) {
        std::array<double, 2> at{};
        at[std::size_t(apex.ruled)] = far;
        at[std::size_t(1 - apex.ruled)] = on.lo + (k + 0.5) / kSamples * on.length();
        const auto j = jet<2>(surface, at);
        const Vec<3> m = cross(j(1, 0), j(0, 1)), second = apex.ruled == 1 ? j(2, 0) : j(0, 2);
        if (norm(m) > 0) seen += std::abs(dot(unit(m), second));
        all += norm(second);
    }
    return seen > kWorth * all;
}

}  // namespace freiform
