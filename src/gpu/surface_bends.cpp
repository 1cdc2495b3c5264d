// Bounds of second derivatives, and what follows for cells.
//
// Idea. A triangle is apart from its surface by no more than second derivatives allow; pieces that share a
// side must be cut there alike.
//
// Notation. s, t in [0, 1] place in a piece; M_ss, M_st, M_tt bounds of its second derivatives
// (derivative_bounds.hpp); h, k the sides of a cell.
//
// Method. Let a triangle lie in a box of h by k, x_i its corners, l_i the barycentric coordinates of a place
// x in it. The triangle drawn and the surface are apart by |sum l_i (S(x_i) - S(x))| <= sum l_i Q(x_i - x) /
// 2, Q(d) = M_ss ds^2 + 2 M_st |ds dt| + M_tt dt^2. The sum of l_i ds_i^2 is a variance of numbers from an
// interval of length h, at most h^2 / 4 [Popoviciu 1935], and that of |ds dt| at most h k / 4 by Cauchy's
// inequality. So the distance is at most (M_ss h^2 + 2 M_st h k + M_tt k^2) / 8 at the same place, for every
// triangle in the box. With 2 M_st h k <= M_st (r h^2 + k^2 / r), r > 0 the same for the whole face, it
// splits into a part for each direction. All pieces of a column take the largest of their first part, all of
// a row that of the second: neighbours have the same points on their common side, and no crack opens. The two
// parts share the deviation so that the number of cells is least, a : c as their roots.
//
// References: [Filip Magedson Markot 1986] for right triangles.
//
// Why not levels per side of a piece: triangles between sides of different levels lie in larger boxes, and
// how they are put together is left to the driver.
#include "gpu/surface_bends_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

struct SecondDerivatives {
    double ss = 0, st = 0, tt = 0;
    void include(const SecondDerivatives& o) {
        ss = std::max(ss, o.ss), st = std::max(st, o.st), tt = std::max(tt, o.tt);
    }
};

constexpr int kHalvings = 2;  // per direction: control points of high degrees are far from their surface

SecondDerivatives bounds_of(const Net<2, Hom<3>>& net, std::array<double, 2> width, int halvings, int axis) {
    if (halvings == 0) {
        const auto b = derivative_bounds<2, Hom<3>>(net.view(), width);
        return {b(2, 0), b(1, 1), b(0, 2)};
    }
    const int next = axis == 0 ? halvings : halvings - 1;
    if (net.extent()[std::size_t(axis)] == 2 && net.extent()[std::size_t(1 - axis)] == 2)
        return bounds_of(net, width, 0, 0);
    Net<2, Hom<3>> low = net, high = net;
    each_fibre(axis, net.extent(), [&](const Index<2>& at) {
        keep_left(low.view().fibre(axis, at), 0.5);
        keep_right(high.view().fibre(axis, at), 0.5);
    });
    width[std::size_t(axis)] /= 2;
    SecondDerivatives out = bounds_of(low, width, next, 1 - axis);
    out.include(bounds_of(high, width, next, 1 - axis));
    return out;
}

// Of a triangle of degree n: all of second order are at most as long. Differences of the coefficients
// about a point near them, as block_bounds.cpp has it; parts are half as large.
double second_derivative(const SimplexPatch<2, Hom<3>>& s, int halvings) {
    const int n = s.degree();
    if (halvings > 0) {
        double most = 0;
        for (const auto& part : split_in_four(s))
            most = std::max(most, 4 * second_derivative(part, halvings - 1));
        return most;
    }
    const Vec<3> centre = project(s.coefficient(n / 3, n / 3));
    const auto at = [&](int j, int k) {
        Hom<3> h = s.coefficient(j, k);
        for (int c = 0; c < 3; ++c) h[c] -= h.weight() * centre[c];
        return h;
    };
    const auto step = [&](int j, int k, int d) { return (d == 0 ? at(j + 1, k) : at(j, k + 1)) - at(j, k); };
    const auto length = [](const Hom<3>& h) { return std::hypot(h[0], h[1], h[2]); };
    double radius = 0, least = kInfinity, first = 0, weight_first = 0, second = 0, weight_second = 0;
    for (int j = 0; j <= n; ++j)
        for (int k = 0; j + k <= n; ++k) {
            least = std::min(least, at(j, k).weight());
            radius = std::max(radius, norm(project(at(j, k))));
            for (const int d : {0, 1}) {
                if (j + k + 1 > n) continue;
                first = std::max(first, n * length(step(j, k, d)));
                weight_first = std::max(weight_first, n * std::abs(step(j, k, d).weight()));
                if (j + k + 2 > n) continue;
                for (const int e : {0, 1}) {
                    const Hom<3> twice = (e == 0 ? step(j + 1, k, d) : step(j, k + 1, d)) - step(j, k, d);
                    second = std::max(second, n * (n - 1) * length(twice));
                    weight_second = std::max(weight_second, n * (n - 1) * std::abs(twice.weight()));
                }
            }
        }
    const double slope = (first + weight_first * radius) / least;
    return (second + 2 * weight_first * slope + weight_second * radius) / least;
}

std::vector<SecondDerivatives> second_derivatives(const Face& face, const SurfacePieces& p) {
    std::vector<SecondDerivatives> out;
    if (p.distance == 0) {
        for (const Net<2, Hom<3>>& net : p.nets) out.push_back(bounds_of(net, {1, 1}, kHalvings, 0));
        return out;
    }
    // Of the offset itself, by its own parameters.
    const DerivativeQuery<2, 3> query(face.surface);
    for (const ParameterMap& u : p.u)
        for (const ParameterMap& v : p.v) {
            const auto b = query({u.on, v.on});
            out.push_back({b(2, 0) * u.slope() * u.slope() + b(1, 0) * u.bend(),
                           b(1, 1) * u.slope() * v.slope(),
                           b(0, 2) * v.slope() * v.slope() + b(0, 1) * v.bend()});
        }
    return out;
}

}  // namespace

std::array<std::vector<double>, 2> bends_of(const Face& face, const SurfacePieces& pieces) {
    const std::vector<SecondDerivatives> all = second_derivatives(face, pieces);
    const std::size_t columns = pieces.u.size(), rows = pieces.v.size();
    SecondDerivatives most;
    for (const SecondDerivatives& m : all) most.include(m);
    const double both = most.st > 0 ? std::sqrt((most.ss + most.st) / (most.tt + most.st)) : 1;
    std::array<std::vector<double>, 2> out{std::vector<double>(columns, 0.0), std::vector<double>(rows, 0.0)};
    std::array<double, 2> largest{};
    for (std::size_t i = 0; i < columns; ++i)
        for (std::size_t j = 0; j < rows; ++j) {
            const SecondDerivatives& m = all[i * rows + j];
            out[0][i] = std::max(out[0][i], m.ss + both * m.st);
            out[1][j] = std::max(out[1][j], m.tt + m.st / both);
            largest = {std::max(largest[0], out[0][i]), std::max(largest[1], out[1][j])};
        }
    const double sum = std::sqrt(largest[0]) + std::sqrt(largest[1]);
    for (const std::size_t d : {std::size_t(0), std::size_t(1)})
        for (double& b : out[d]) b = largest[d] > 0 ? b * sum / (8 * std::sqrt(largest[d])) : 0;
    return out;
}

// All three second derivatives are at most M. Between the rings of the hardware's tessellation, which are 2 h
// / 3 apart, a triangle has a box of h by 4 h / 3: (1 + 4 / 3)^2 M h^2 / 8, or 49 / 72, and a little for
// places that the hardware has as fixed-point numbers of 16 bits.
double bend_of(const SimplexPatch<2, Hom<3>>& triangle) {
    return 0.7 * second_derivative(triangle, kHalvings);
}

}  // namespace freiform
