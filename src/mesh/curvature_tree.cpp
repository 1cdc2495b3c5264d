// Idea: the distance between a surface and a triangle through three of its points is bounded by second
// derivatives alone. Control points bound those (derivative_bounds.cpp), so the mesh is fine exactly where
// the proof asks for it.
//
// Notation: T triangle in the parameter plane with corners v_i, x in T with barycentric coordinates l_i, L f
// the linear interpolant, d_i = v_i - x, Q(d) = M_uu du^2 + 2 M_uv |du dv| + M_vv dv^2 >= |D^2 f (d, d)|.
// Bound: Taylor's formula about x and sum l_i d_i = 0 give f(x) - L f(x) = -1/2 sum l_i D^2 f(x_i)(d_i, d_i)
// per component, so |f - L f| <= 1/2 sum l_i Q(d_i). For any s > 0, 2 |du dv| <= s du^2 + dv^2 / s, so Q is
// at most the diagonal form |d|_g^2 = A du^2 + B dv^2, A = M_uu + s M_uv, B = M_vv + M_uv / s. For every
// point c, sum l_i |v_i - x|_g^2 = sum l_i |v_i - c|_g^2 - |x - c|_g^2 <= R^2, R the radius about c that
// contains T. With the smallest such circle
//     |f - L f| <= R^2 / 2,
// R half the longest side of an obtuse triangle, else its circumradius, both in the metric g. For vectors f
// the argument is applied to f . e, e any unit vector. Delaunay triangulations in g minimise the largest R.
// Saddles: where a function f has f_uu >= a > 0, f_vv <= -b < 0, |f_uv| <= c, D^2 f (d, d) >= a du^2 - 2 c
// |du dv| - M_vv dv^2 >= -(M_vv + c^2 / a) dv^2, so f - L f <= (M_vv + c^2 / a) / 2 sum l_i dv_i^2, and that
// sum is at most the quarter of the squared extent of T along v. Likewise L f - f <= (M_uu + c^2 / b) du^2 /
// 8: the larger of both counts, not their sum, so that saddles need half as many triangles as domes. Kinks:
// where f_u jumps by at most J across u = u0, f has the part J (u - u0)_+ more (in the limit of smoothings of
// f); its interpolant on a triangle from u0 - a to u0 + b is off by at most J a b / (a + b). Applied to all
// of S, this bounds more than the distance; bending.cpp applies it to what is seen along normals. Bounds over
// a box hold over its parts: the halves of a box that is not fine mostly are by its own bounds, unless
// normals turn much within it, and need none of their own. The tree halves boxes: parts of a third or a
// fifth, which would fit uniform curvature better, cost more points where boxes of different sizes meet (a
// fifth more triangles on the models of bench/REPORT.md); columns of the whole box do not
// (curvature_tree_columns.cpp). References: [Waldron 1998] (min-containment
// radius), [Filip Magedson Markot 1986] (second derivatives). Why not sampling: a bump between the samples is
// missed, see the adversarial bump in the tests.
#include "curvature_tree_detail.hpp"
#include "parameter_table_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/face_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace freiform {

namespace {

constexpr double kProofSlack = 1 + 1e-11;  // more than the roundings of bounds over cells

// Half of the squared min-containment radius with the metric diag(A, B).
double half_squared_radius(double A, double B, const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
    const auto length2 = [&](const Vec<2>& p, const Vec<2>& q) {
        const Vec<2> d = q - p;
        return A * d[0] * d[0] + B * d[1] * d[1];
    };
    double s[3] = {length2(a, b), length2(b, c), length2(c, a)};
    for (const int k : {0, 1})  // the longest is the last
        if (s[k] > s[2]) std::swap(s[k], s[2]);
    const double longest = s[2] / 8;
    if (s[0] + s[1] <= s[2]) return longest;
    const double twice_area = std::abs(cross(b - a, c - a));  // squared circumradius: s0 s1 s2 / (16 area^2)
    const double sixteen_area2 = 4 * A * B * twice_area * twice_area;
    // An acute triangle has R <= longest / sqrt(3) of its sides, also where rounding spoils the quotient.
    const double acute = s[2] / 6;
    return sixteen_area2 > 0 ? std::min(acute, s[0] * s[1] * s[2] / sixteen_area2 / 2) : acute;
}

}  // namespace

Curvature seen_at(const Jet<2, 2, Vec<3>>& j, bool along_normal) {
    const Vec<3> m = cross(j(1, 0), j(0, 1));
    if (!along_normal || !(norm(m) > 0)) return {norm(j(2, 0)), norm(j(1, 1)), norm(j(0, 2))};
    const Vec<3> n = unit(m);
    const double uu = dot(n, j(2, 0)), vv = dot(n, j(0, 2));
    return {std::abs(uu), std::abs(dot(n, j(1, 1))), std::abs(vv), uu, vv};
}

namespace {

// In a part of the face of the size h, one of `count` along each axis. Half of the error for each direction,
// and what mixed derivatives ask for beside it; halving makes boxes finer than necessary, by kHalving on
// average. What is seen along the normal counts, where there is one, and a little of the rest; and the whole
// may be as much as feet allow (bending.cpp).
double triangles_at(const Jet<2, 2, Vec<3>>& j, const Vec<2>& h, int count, const FaceDemands& demands) {
    constexpr double kHalving = 1.5, kHalvedLength = 2, kAside = 1.0 / 16, kFootQ = 0.1;
    const double tolerance = demands.tolerance, part = 1.0 / count;
    const Vec<3> m = cross(j(1, 0), j(0, 1)), n = norm(m) > 0 ? unit(m) : Vec<3>{};
    const bool has_normal = norm(m) > 0 && !demands.apex;  // of cones all counts, but for mixed derivatives
    double whole = tolerance;
    if (has_normal) {
        const double a = norm(j(1, 0)), b = norm(j(0, 1)),
                     least = 1 - std::abs(dot(j(1, 0), j(0, 1))) / (a * b);
        const double bent =
            norm(j(1, 1)) / (a * b) + std::max(norm(j(2, 0)) / (a * a), norm(j(0, 2)) / (b * b));
        whole = std::max(whole, kFootQ * least / bent);
    }
    const auto bend = [&](const Vec<3>& second) {  // beside 8 tolerances
        const double all = norm(second), seen = std::abs(dot(n, second)) + kAside * all;
        return kHalving * (has_normal ? std::max(seen, all * (tolerance / whole)) : all) / (8 * tolerance);
    };
    const auto cuts = [&](const Vec<3>& first, const Vec<3>& second, double length) {
        const double by_length = norm(first) * length / demands.max_edge;
        return std::sqrt(part * part + 2 * bend(second) * length * length +
                         kHalvedLength * by_length * by_length);
    };
    const double mixed = demands.apex ? 0 : 2 * bend(j(1, 1)) * h[0] * h[1];
    return 2 * (cuts(j(1, 0), j(2, 0), h[0]) * cuts(j(0, 1), j(0, 2), h[1]) + mixed);
}

}  // namespace

double estimated_triangles(const SurfaceGeometry& surface, const Box<2>& box, const FaceDemands& demands,
                           int samples) {
    const Vec<2> h = (1.0 / samples) * (box.hi - box.lo);
    double sum = 0;
    for (int i = 0; i < samples; ++i)
        for (int k = 0; k < samples; ++k)
            sum += triangles_at(jet<2>(surface, {box.lo[0] + (i + 0.5) * h[0], box.lo[1] + (k + 0.5) * h[1]}),
                                h, samples, demands);
    return std::isfinite(sum) ? sum : 0;
}

double linear_interpolation_bound(const Curvature& c, const Vec<2>& a, const Vec<2>& b, const Vec<2>& d) {
    const double grow = 1 + 1e-14;  // the roundings of this function
    if (c.uv == 0 && !c.is_saddle()) return grow * half_squared_radius(c.uu, c.vv, a, b, d);
    Box<2> box;
    for (const Vec<2>& p : {a, b, d}) box.add(p);
    const Vec<2> size = box.hi - box.lo;
    double best = std::numeric_limits<double>::infinity();
    if (c.is_saddle()) {
        const Curvature k = c.apart();
        best = std::max(k.uu * size[0] * size[0], k.vv * size[1] * size[1]) / 8;
        if (c.uv == 0) return grow * std::min(best, half_squared_radius(c.uu, c.vv, a, b, d));
    }
    const auto attempt = [&](double s) {
        if (s > 0 && std::isfinite(s) && 1 / s < std::numeric_limits<double>::infinity())
            best = std::min(best, half_squared_radius(c.uu + s * c.uv, c.vv + c.uv / s, a, b, d));
    };
    attempt(size[1] / size[0]);
    if (c.uu > 0 && c.vv > 0) attempt(std::sqrt(c.uu / c.vv));
    return grow * best;
}

// Half the squared radius of the smallest circle around a triangle with such squared sides. The angle
// opposite the longest has a cosine of (s0 + s1 - s2) / (2 sqrt(s0 s1)), at most sqrt(s0 / s1) / 2 as s1 <=
// s2. Where that would be negative, sides or none, the largest is at the middle of the longest.
double largest_of_sides(std::array<double, 3> s, double slip) {
    const double lower = std::min(s[0], s[1]), upper = std::max(s[0], s[1]), least = std::min(lower, s[2]),
                 middle = std::max(lower, std::min(upper, s[2])), most = std::max(upper, s[2]);
    const double beyond = least + middle - most + slip;
    if (beyond <= 0 || !(middle > slip)) return most / 8 + slip;
    // The square of the cosine, as a quotient: of the sides, or of what it is at most.
    const double whole = 4 * middle, found = beyond * beyond, at_most = least + slip;
    const double part = found < at_most * least ? found / least : at_most;
    return most / 8 * (whole / (whole - part)) + 4 * slip;
}

double quadratic_error(const std::array<Vec<3>, 3>& second, const std::array<Vec<2>, 3>& corner,
                       double slip) {
    std::array<double, 3> s;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec<2> d = corner[(k + 1) % 3] - corner[k];
        s[k] = norm(d[0] * d[0] * second[0] + 2 * d[0] * d[1] * second[1] + d[1] * d[1] * second[2]);
    }
    return largest_of_sides(s, slip);
}

bool is_thin(const std::array<Vec<2>, 3>& corner) {
    constexpr double kThin = 0.1;  // area, over the longest side squared
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec<2> d = corner[(k + 1) % 3] - corner[k];
        longest = std::max(longest, dot(d, d));
    }
    return !(std::abs(cross(corner[1] - corner[0], corner[2] - corner[0])) > kThin * longest);
}

// The error is sum l_i l_j Q(v_i - v_j) / 2. Of indefinite ones it has no extreme inside, and on a side one
// of an eighth of what they are along it.
double Quadratic::error(const std::array<Vec<2>, 3>& corner) const {
    const Vec<2> side[3] = {corner[1] - corner[0], corner[2] - corner[1], corner[0] - corner[2]};
    std::array<double, 3> s;
    double size = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double u = uu * side[k][0] * side[k][0], v = vv * side[k][1] * side[k][1],
                     both = 2 * uv * side[k][0] * side[k][1];
        s[k] = std::abs(u + both + v);
        size = std::max(size, std::abs(u) + std::abs(both) + std::abs(v));
    }
    const double slip = 16 * kUnitRoundoff * size;
    const bool is_indefinite = uu * vv - uv * uv < -8 * kUnitRoundoff * (std::abs(uu * vv) + uv * uv);
    return is_indefinite ? std::max({s[0], s[1], s[2]}) / 8 + slip : largest_of_sides(s, slip);
}

double Quadratic::halves_error(const Vec<2>& size) const {
    return error(half_of({{}, size}, prefers_rising(size)));
}

double Quadratic::fan_error(const Vec<2>& size) const {
    const Vec<2> centre = 0.5 * size, u{{size[0], 0}}, v{{0, size[1]}};
    return std::max(error({Vec<2>{}, u, centre}), error({Vec<2>{}, centre, v}));
}

// At the kink that is nearest to the middle if there is one, else across the axis, between columns where it
// has more than one.
std::optional<CurvatureTree::Cut> CurvatureTree::cut(const Node& node, int axis) const {
    const Box<2>& box = node.box;
    const Vec<2> size = box.hi - box.lo;
    Cut out{axis, box.side(axis).middle()};
    if (const auto [first, end] = node.columns[std::size_t(axis)]; end - first > 1) {
        out.column = (first + end) / 2;
        out.at = columns_[std::size_t(axis)][std::size_t(out.column)];
    }
    double nearest = size[axis];
    for (int d = 0; d < 2; ++d)
        for (const Kink& k : kinks_[std::size_t(d)])
            if (box.lo[d] < k.at && k.at < box.hi[d] && k.jump > 0) {
                const double distance = std::abs(k.at - box.side(d).middle()) / size[d] * size[axis];
                if (distance < nearest) nearest = distance, out = {d, k.at};
            }
    if (!(box.lo[out.axis] < out.at && out.at < box.hi[out.axis])) return std::nullopt;
    return out;
}

bool CurvatureTree::keeps(const Bending& b, const Vec<2>& size, bool kinks, double error,
                          double tolerance) const {
    if (error <= tolerance) return true;
    if (!knows_normals_ || kinks) return false;
    const Shift shift = shift_of(b, error, b.full, 1, false);
    return shift.exists && shift.across(b.seen(shift.turn).error(size), error) <= tolerance;
}

// What only the sharper bound allows has to allow for what is beside the cell, too: where blocks fail, the
// triangles around them have that bound for less.
bool CurvatureTree::keeps(const Bending& b, const Box<2>& cell, bool kinks, double error, double tolerance,
                          Proof& proof) const {
    if (kinks || !b.knows_middle()) return keeps(b, cell.hi - cell.lo, kinks, error, tolerance);
    if (error <= tolerance) return true;
    const double of_halves = kProofSlack * b.whole_halves_error(cell);
    // Slivers beside it have bounds of their own, which may be worse than those of halves with that side.
    const auto sides_keep = [&](bool along_normal) {
        return b.sides_error(cell.hi - cell.lo, along_normal) <= tolerance;
    };
    const double whole = proof.whole = std::min(kProofSlack * error, of_halves);
    const Shift shift = knows_normals_ ? shift_of(b, whole, b.full, kBeyond, true) : Shift{};
    if (of_halves <= tolerance && sides_keep(false)) {
        if (shift.exists) proof.bound = whole;
        return true;
    }
    if (!knows_normals_) return false;
    if (shift.exists) {
        const double seen = b.halves_error(cell, shift.turn, shift.left_of(tolerance, whole));
        const double bound = kProofSlack * shift.across(seen, whole);
        const bool keeps = bound <= tolerance;
        if (keeps) proof.bound = bound;
        if (keeps && sides_keep(true)) return true;
        if (!keeps && b.fit.exists()) return false;  // nor will what says less
    }
    const Shift other = shift_of(b, error, b.full, kBeyond, true);
    return other.exists && other.across(b.seen_error(cell, other.turn), error) <= tolerance;
}

// The same of all cells of a block in a box of this size.
bool CurvatureTree::keeps_in_cells(const Bending& b, const Vec<2>& box, const Vec<2>& cell,
                                   double tolerance) const {
    const double error = b.full.along(cell[0], cell[1]) / 8;
    if (keeps(b, cell, false, error, tolerance)) return true;
    if (!knows_normals_ || !b.knows_middle()) return false;
    const Shift shift = shift_of(b, error, b.full, kBeyond, true);
    return shift.exists && shift.across(b.cells_error(box, cell, shift.turn), error) <= tolerance;
}

bool CurvatureTree::accept(Node& node, const Bending& known, double error, double tolerance,
                           Proof& proof) const {
    node.flat = error <= tolerance;
    if (node.flat) return true;
    const bool kinks = meets_kink(node.box);
    return !node.has_columns() ? keeps(known, node.box, kinks, error, tolerance, proof)
                               : keeps(known, node.box.hi - node.box.lo, kinks, error, tolerance);
}

bool CurvatureTree::meets_kink(const Box<2>& box) const {
    for (int d = 0; d < 2; ++d)
        for (const Kink& k : kinks_[std::size_t(d)])
            if (box.lo[d] <= k.at && k.at <= box.hi[d]) return true;
    return false;
}

// Not at its edge: then nothing is known of normals on one side from those on the other.
bool CurvatureTree::is_sharp_inside(const Box<2>& box) const {
    for (int d = 0; d < 2; ++d)
        for (const double at : sharp_[std::size_t(d)])
            if (box.lo[d] < at && at < box.hi[d]) return true;
    return false;
}

bool CurvatureTree::is_outside(const Box<2>& box) const {
    int stack[2 * kMaxTreeDepth + 4], size = 0;
    stack[size++] = 0;
    while (size > 0) {
        const Node& n = nodes_[std::size_t(stack[--size])];
        if (n.outside || !has_common_part(n.box, box)) continue;
        if (n.child < 0) return false;
        stack[size++] = n.child;
        stack[size++] = n.child + 1;
    }
    return true;
}

int CurvatureTree::place_of(const Box<2>& box, int near) const {
    const auto holds = [&](int n) {
        const Box<2>& b = nodes_[std::size_t(n)].box;
        return b.contains(box.lo) && b.contains(box.hi);
    };
    while (near != 0 && !holds(near)) near = nodes_[std::size_t(near)].parent;
    for (int child; (child = nodes_[std::size_t(near)].child) >= 0;) {
        if (!holds(child) && !holds(++child)) break;
        near = child;
    }
    return near;
}

const Curvature* CurvatureTree::all_in(int place, const Box<2>& box) const {
    const Node& n = nodes_[std::size_t(place)];
    return n.whole && n.box.contains(box.lo) && n.box.contains(box.hi) ? &full(n) : nullptr;
}

Bending CurvatureTree::over(const Box<2>& box, int place) const {
    Bending all;
    bool any = false;
    int stack[2 * kMaxTreeDepth + 4], size = 0;
    stack[size++] = place;
    while (size > 0) {
        const Node& n = nodes_[std::size_t(stack[--size])];
        if (n.outside || !has_common_part(n.box, box)) continue;
        if (n.child < 0) {
            if (any) all.include(bending(n));
            if (!any) all = bending(n);
            any = true;
            continue;
        }
        stack[size++] = n.child;
        stack[size++] = n.child + 1;
    }
    return all;
}

std::optional<Curvature> CurvatureTree::all_over(const Box<2>& box, int place) const {
    if (!nodes_[0].box.contains(box.lo) || !nodes_[0].box.contains(box.hi)) return std::nullopt;
    Curvature all;
    int stack[2 * kMaxTreeDepth + 4], size = 0;
    stack[size++] = place;
    while (size > 0) {
        const Node& n = nodes_[std::size_t(stack[--size])];
        if (!has_common_part(n.box, box)) continue;
        if (n.outside) return std::nullopt;
        if (n.child < 0) {
            all.include(bending(n).full);
            continue;
        }
        stack[size++] = n.child;
        stack[size++] = n.child + 1;
    }
    return all;
}

double CurvatureTree::kink_bound(const Box<2>& box) const {
    return kink_bound_of(kinks_[0], box.side(0)) + kink_bound_of(kinks_[1], box.side(1));
}

std::optional<std::pair<int, double>> CurvatureTree::worst_kink(const Box<2>& box) const {
    std::optional<std::pair<int, double>> worst;
    double most = 0;
    for (int d = 0; d < 2; ++d)
        for (const Kink& k : kinks_[std::size_t(d)])
            if (const double e = kink_bound_of(std::span(&k, 1), box.side(d)); e > most)
                most = e, worst = {d, k.at};
    return worst;
}

void CurvatureTree::find_corners() {
    ParameterTable seen(nodes_.count() / 16);  // most are of blocks
    std::vector<int> stack{0};
    while (!stack.empty()) {
        const int at = stack.back();
        const Node& n = nodes_[std::size_t(at)];
        stack.pop_back();
        if (n.outside) continue;
        if (n.child >= 0) {
            stack.push_back(n.child + 1);
            stack.push_back(n.child);
            continue;
        }
        if (n.block >= 0) blocks_[std::size_t(n.block)].node = at;
        if (n.is_block()) continue;
        for (int k = 0; k < 4; ++k) {
            const Vec<2> corner{{k & 1 ? n.box.hi[0] : n.box.lo[0], k & 2 ? n.box.hi[1] : n.box.lo[1]}};
            if (seen.add(corner)) corners_.push_back({corner, n.box.hi - n.box.lo});
        }
    }
}

Vec<2> CurvatureTree::mean_leaf() const {
    Vec<2> sum{};
    double count = 0;
    nodes_.each_place([&](std::size_t i) {
        const Node& n = nodes_[i];
        if (n.child >= 0 || n.outside) return;
        const Vec<2> size = n.box.hi - n.box.lo;
        const Halves halves = n.block < 0 ? Halves{} : blocks_[std::size_t(n.block)].halves;
        const double along[2] = {std::ldexp(1.0, halves[0]), std::ldexp(1.0, halves[1])};
        sum += Vec<2>{{along[1] * size[0], along[0] * size[1]}}, count += along[0] * along[1];
    });
    return (1 / std::max(count, 1.0)) * sum;
}

}  // namespace freiform
