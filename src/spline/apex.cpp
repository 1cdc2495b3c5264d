// Whether a surface is a cone, a cylinder or a sphere.
//
// Of splines: with the control points A_j and B_j of two rows, and equal weights in both, S is a cone if
// A_j - P = k (B_j - P) for all j, for then S(u, v) - P is a multiple of the curve of the row B less P. k is
// found from A_j - A_0 = k (B_j - B_0) by least squares; P from the means of the rows. What is left of A_j -
// P - k (B_j - P) bounds the slip by convexity: it is largest in the row A, and nothing in the row B. B is
// the row that extends farther, so |k| is at most about 1; where it is 1 the rows are moved copies, and
// the surface is a cylinder. Weights that differ by a part e move points by 2 e of the size, at most, against
// those of either row.
//
// More rows are as good as two where they lie between the first and the last as their Greville abscissae do:
// splines of these are v itself, so what they are beside that bounds what lines are, by convexity. It counts
// twice, as what surfaces are compared with is one of their own lines.
//
// Of revolutions of Q + v D about an axis, or of splines that are such lines likewise: at the v where the
// line is nearest to the axis; its distance from there is the slip, turned. Lines that hardly lean have that
// v too far away to be known: they are beside the parallel to the axis in the middle of a part by what they
// lean from there, which is counted over twice the part (it may be of samples). Of circles: what its vectors
// are beside the plane of the axis, and what they and the centre are off those of a circle about a point of
// it.
#include <freiform/basis/greville.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/apex.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace freiform {

namespace {

constexpr double kMostSlip = 0x1p-16;     // of the size
constexpr double kFarApex = 1 - 0x1p-20;  // k, beyond which it is a cylinder, if anything
constexpr double kRoundings = 64 * kUnitRoundoff;

std::optional<Apex> sphere_of(const Revolution& s) {
    const auto* circle = std::get_if<Conic<3>>(&s.profile);
    if (!circle || circle->kind != ConicKind::ellipse) return std::nullopt;
    const auto across = [&](const Vec<3>& x) { return x - dot(x, s.axis) * s.axis; };
    const Vec<3> x = across(circle->x), y = across(circle->y), out = norm(x) > norm(y) ? x : y;
    Apex found;
    found.radius = (norm(circle->x) + norm(circle->y)) / 2;
    if (!(norm(out) > 0) || !(found.radius > 0)) return std::nullopt;
    found.outwards = unit(out);
    const auto beside = [&](const Vec<3>& d) { return norm(d - dot(d, found.outwards) * found.outwards); };
    found.slip = norm(across(circle->centre - s.origin)) + beside(x) + beside(y) +
                 std::abs(norm(circle->x) - norm(circle->y)) +
                 std::abs(dot(circle->x, circle->y)) / found.radius +
                 kRoundings * (norm(circle->centre) + norm(s.origin) + found.radius);
    return found.slip <= kMostSlip * found.radius ? std::optional(found) : std::nullopt;
}

// Control points of a spline along one axis, weights the same everywhere else.
struct Row {
    std::vector<Vec<3>> points;
    std::vector<double> weights;
};

// What rows between the first and the last are beside lines from one to the other; infinite where it is too
// much, or nothing is known. Weights are off by `uneven`, relatively.
double beside_lines(const BSplineBasis& basis, const std::function<Row(int)>& row, double& uneven) {
    const int n = basis.size();
    if (basis.is_closed() || basis.degree() < 1) return kInfinity;
    const Row first = row(0), last = row(n - 1);
    const double from = greville(basis, 0), to = greville(basis, n - 1);
    double most = 0, size = 0;
    for (std::size_t j = 0; j < first.points.size(); ++j)
        size = std::max(size, norm(first.points[j] - last.points[j]));
    const double slip = kRoundings * size * (1 + std::max(std::abs(from), std::abs(to)) / (to - from));
    for (int i = 1; i + 1 < n && most <= kMostSlip * size; ++i) {
        const Row here = row(i);
        const double part = (greville(basis, i) - from) / (to - from);
        for (std::size_t j = 0; j < here.points.size(); ++j) {
            const Vec<3> between = (1 - part) * first.points[j] + part * last.points[j];
            const double w = here.weights[j], v = first.weights[j];
            most = std::max(most, norm(here.points[j] - between) + slip);
            uneven = std::max(uneven, std::abs(w - v) / std::min(w, v));
        }
    }
    return most <= kMostSlip * size ? most : kInfinity;
}

// A line, and what the curve is beside it at the same parameters.
struct NearLine {
    Line<3> line;
    double beside = 0;
};
std::optional<NearLine> near_line(const BSplineBasis& basis, const Row& net) {
    double uneven = 0;
    const auto row = [&](int i) { return Row{{net.points[std::size_t(i)]}, {net.weights[std::size_t(i)]}}; };
    const double beside = beside_lines(basis, row, uneven);
    if (!(beside < kInfinity)) return std::nullopt;
    const double from = greville(basis, 0), to = greville(basis, basis.size() - 1), w = net.weights.front(),
                 v = net.weights.back();
    const Vec<3> way = net.points.back() - net.points.front(), direction = (1 / (to - from)) * way;
    uneven = std::max(uneven, std::abs(v - w) / std::min(v, w));
    const NearLine out{{net.points.front() - from * direction, direction}, beside + 8 * uneven * norm(way)};
    return out.beside < kMostSlip * norm(way) ? std::optional(out) : std::nullopt;
}
std::optional<NearLine> near_line(const CurveGeometry<3>& curve) {
    return visit_one(
        [&](const auto& c) -> std::optional<NearLine> {
            if constexpr (std::same_as<std::remove_cvref_t<decltype(c)>, Line<3>>) return NearLine{c, 0};
            if constexpr (requires { c.net(); }) {
                Row net;
                for (const auto& p : c.net().flat()) {
                    net.points.push_back(project(p));
                    net.weights.push_back(Space<std::remove_cvref_t<decltype(p)>>::weight(p));
                }
                return near_line(c.basis(), net);
            }
            return std::nullopt;
        },
        curve);
}

std::optional<Apex> apex_of(const Revolution& s, const Box<2>& part) {
    const auto near = near_line(s.profile);
    if (!near) return sphere_of(s);
    const Line<3>* const line = &near->line;
    const auto across = [&](const Vec<3>& x) { return x - dot(x, s.axis) * s.axis; };
    const Vec<3> from = line->origin - s.origin, q = across(from), d = across(line->direction);
    const double speed = norm(line->direction);
    std::optional<Apex> cone, cylinder;
    if (norm(d) > kRoundings * speed) {
        const double at = -dot(q, d) / dot(d, d), size = norm(from) + std::abs(at) * speed;
        cone.emplace().at = at;
        cone->slip = norm(q + at * d) + kRoundings * (size + norm(s.origin));
    }
    if (const Interval on = part.side(1); !part.is_empty() && std::isfinite(on.length())) {
        const double middle = on.middle(), lean = norm(d) * on.length(),
                     size = norm(from) + (std::abs(middle) + on.length()) * speed;
        cylinder.emplace().at = kInfinity;
        cylinder->part = {middle - on.length(), middle + on.length()};
        cylinder->slip = lean + kRoundings * (size + norm(s.origin));
        if (!(cylinder->slip <= kMostSlip * norm(q + middle * d))) cylinder.reset();
    }
    if (cone && cylinder && cylinder->slip < cone->slip) cone = cylinder;
    if (!cone) cone = cylinder;
    if (cone) cone->slip += 2 * near->beside;
    return cone;
}

// One row along the other axis.
template <class P>
Row row_of(const Surface<P>& s, int axis, int which) {
    const NetView<2, const P> net = s.net().view();
    Row out;
    for (int i = 0; i < net.extent[std::size_t(1 - axis)]; ++i) {
        const P& p = net(axis == 0 ? Index<2>{which, i} : Index<2>{i, which});
        out.points.push_back(project(p));
        out.weights.push_back(Space<P>::weight(p));
    }
    return out;
}

Vec<3> mean_of(const std::vector<Vec<3>>& row) {
    Vec<3> sum{};
    for (const Vec<3>& p : row) sum += p;
    return (1.0 / double(row.size())) * sum;
}

// Of the lines from the row at the parameter on.lo to that at on.hi, where weights in between are as uneven,
// relatively.
std::optional<Apex> apex_of_rows(int axis, Interval on, Row near, Row far, double uneven) {
    const std::size_t n = near.points.size();
    for (std::size_t j = 0; j < n; ++j)
        uneven = std::max(
            uneven, std::abs(near.weights[j] - far.weights[j]) / std::min(near.weights[j], far.weights[j]));
    Vec<3> a = mean_of(near.points), b = mean_of(far.points);
    double of_near = 0, of_far = 0, both = 0;
    for (std::size_t j = 0; j < n; ++j) {
        const Vec<3> x = near.points[j] - a, y = far.points[j] - b;
        of_near += dot(x, x), of_far += dot(y, y), both += dot(x, y);
    }
    double from = on.lo, to = on.hi;
    if (of_near > of_far)
        std::swap(near, far), std::swap(a, b), std::swap(from, to), std::swap(of_near, of_far);
    double k = both / of_far;
    if (!std::isfinite(k)) return std::nullopt;
    // Lines that cross just before the end of their row cross at it, but for a slip.
    if (k < 0 && k >= -kMostSlip) k = 0;
    const bool is_cylinder = k > kFarApex;
    const Vec<3> apex = is_cylinder ? b : (1 / (1 - k)) * (a - k * b);
    const Vec<3> by = is_cylinder ? a - b : Vec<3>{};
    const double scale = is_cylinder ? 1 : k;
    double slip = 0, size = norm(by);
    for (std::size_t j = 0; j < n; ++j) {
        const Vec<3> x = near.points[j] - apex, y = far.points[j] - apex;
        slip = std::max(slip, norm(x - by - scale * y));
        size = std::max({size, norm(x), norm(y)});
    }
    slip += kRoundings * (norm(apex) + size) + 8 * uneven * size;
    if (!(slip <= kMostSlip * size)) return std::nullopt;
    Apex out;
    out.ruled = axis, out.slip = slip;
    out.at = is_cylinder ? kInfinity : (from - k * to) / (1 - k);
    return out;
}

std::optional<Apex> apex_along(int axis, const BSplineBasis& basis, const std::function<Row(int)>& row) {
    const int last = basis.size() - 1;
    double uneven = 0;
    const double beside = beside_lines(basis, row, uneven);
    if (!(beside < kInfinity)) return std::nullopt;
    auto found = apex_of_rows(axis, {greville(basis, 0), greville(basis, last)}, row(0), row(last), uneven);
    if (found) found->slip += 2 * beside;
    return found;
}

}  // namespace

std::optional<Apex> apex_of(const SurfaceGeometry& surface, const Box<2>& part) {
    return visit_one(
        [&](const auto& s) -> std::optional<Apex> {
            if constexpr (requires { s.net(); }) {
                for (const int axis : {1, 0})
                    if (auto found =
                            apex_along(axis, s.basis(axis), [&](int i) { return row_of(s, axis, i); }))
                        return found;
                return std::nullopt;
            } else if constexpr (std::same_as<std::remove_cvref_t<decltype(s)>, Revolution>) {
                return apex_of(s, part);
            } else {
                return std::nullopt;
            }
        },
        surface);
}

}  // namespace freiform
