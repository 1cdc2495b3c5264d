// Whether a surface is a cone or a cylinder.
//
// Of splines: with the control points A_j and B_j of the two rows, and equal weights in both, S is a cone if
// A_j - P = k (B_j - P) for all j, for then S(u, v) - P is a multiple of the curve of the row B less P. k is
// found from A_j - A_0 = k (B_j - B_0) by least squares; P from the means of the rows. What is left of A_j -
// P - k (B_j - P) bounds the slip by convexity: it is largest in the row A, and nothing in the row B. B is
// the row that extends farther, so |k| is at most about 1; where it is 1 the rows are moved copies, and
// cylinders of what is left.
//
// Of revolutions of Q + v D about an axis: at the v where the line is nearest to the axis; its distance from
// there is the slip, turned.
#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/apex.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace freiform {

namespace {

constexpr double kMostSlip = 0x1p-40;      // of the size
constexpr double kEqualWeights = 0x1p-44;  // relative
constexpr double kFarApex = 1 - 0x1p-20;   // k, beyond which it is a cylinder, if anything
constexpr double kRoundings = 64 * kUnitRoundoff;

std::optional<Apex> apex_of(const Revolution& s) {
    const auto* line = std::get_if<Line<3>>(&s.profile);
    if (!line) return std::nullopt;
    const auto across = [&](const Vec<3>& x) { return x - dot(x, s.axis) * s.axis; };
    const Vec<3> from = line->origin - s.origin, q = across(from), d = across(line->direction);
    const double speed = norm(line->direction);
    if (!(norm(d) > kRoundings * speed)) return std::nullopt;
    const double at = -dot(q, d) / dot(d, d), size = norm(from) + std::abs(at) * speed;
    const double slip = norm(q + at * d) + kRoundings * (size + norm(s.origin));
    if (!(slip <= kMostSlip * size)) return std::nullopt;
    return Apex{1, at, slip};
}

// The points of one row, which run along the other axis.
template <class P>
std::vector<Vec<3>> row_of(const Surface<P>& s, int axis, int which) {
    const NetView<2, const P> net = s.net().view();
    std::vector<Vec<3>> out;
    for (int i = 0; i < net.extent[std::size_t(1 - axis)]; ++i)
        out.push_back(project(net(axis == 0 ? Index<2>{which, i} : Index<2>{i, which})));
    return out;
}

template <class P>
bool has_equal_weights(const Surface<P>& s, int axis) {
    if constexpr (Space<P>::kRational) {
        const NetView<2, const P> net = s.net().view();
        for (int i = 0; i < net.extent[std::size_t(1 - axis)]; ++i) {
            const double a = Space<P>::weight(net(axis == 0 ? Index<2>{0, i} : Index<2>{i, 0})),
                         b = Space<P>::weight(net(axis == 0 ? Index<2>{1, i} : Index<2>{i, 1}));
            if (!(std::abs(a - b) <= kEqualWeights * std::min(a, b))) return false;
        }
    }
    return true;
}

template <class P>
std::optional<Apex> apex_of(const Surface<P>& s, int axis) {
    const auto& basis = s.basis(axis);
    if (basis.degree() != 1 || s.net().extent()[std::size_t(axis)] != 2 || !has_equal_weights(s, axis))
        return std::nullopt;
    const Interval on = basis.domain();
    std::vector<Vec<3>> near = row_of(s, axis, 0), far = row_of(s, axis, 1);
    double from = on.lo, to = on.hi;
    const auto mean = [](const std::vector<Vec<3>>& row) {
        Vec<3> sum{};
        for (const Vec<3>& p : row) sum += p;
        return (1.0 / double(row.size())) * sum;
    };
    const auto extent = [&](const std::vector<Vec<3>>& row) {
        double sum = 0;
        for (const Vec<3>& p : row) sum += dot(p - mean(row), p - mean(row));
        return sum;
    };
    if (extent(near) > extent(far)) std::swap(near, far), std::swap(from, to);
    const Vec<3> a = mean(near), b = mean(far);
    double both = 0;
    for (std::size_t j = 0; j < near.size(); ++j) both += dot(near[j] - a, far[j] - b);
    const double k = both / extent(far);
    if (!std::isfinite(k)) return std::nullopt;
    const bool is_cylinder = k > kFarApex;
    const Vec<3> apex = is_cylinder ? b : (1 / (1 - k)) * (a - k * b);
    const Vec<3> by = is_cylinder ? a - b : Vec<3>{};
    const double scale = is_cylinder ? 1 : k;
    double slip = 0, size = norm(by);
    for (std::size_t j = 0; j < near.size(); ++j) {
        slip = std::max(slip, norm(near[j] - apex - by - scale * (far[j] - apex)));
        size = std::max({size, norm(far[j] - apex), norm(near[j] - apex)});
    }
    slip += kRoundings * (norm(apex) + size);
    if constexpr (Space<P>::kRational) slip += 4 * kEqualWeights * size;
    if (!(slip <= kMostSlip * size)) return std::nullopt;
    return Apex{axis, is_cylinder ? kInfinity : (from - k * to) / (1 - k), slip};
}

}  // namespace

std::optional<Apex> apex_of(const SurfaceGeometry& surface) {
    return visit_one(
        [](const auto& s) -> std::optional<Apex> {
            if constexpr (requires { s.net(); }) {
                if (auto found = apex_of(s, 1)) return found;
                return apex_of(s, 0);
            } else if constexpr (std::same_as<std::remove_cvref_t<decltype(s)>, Revolution>) {
                return apex_of(s);
            } else {
                return std::nullopt;
            }
        },
        surface);
}

}  // namespace freiform
