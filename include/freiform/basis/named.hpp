// The named cubic schemes as data: Q(t) = G M T with G the geometry matrix (one column per point or tangent),
// M the basis matrix and T = (t^3, t^2, t, 1)^T, 0 <= t <= 1.
//
// Row i of M holds the coefficients of the basis function that belongs to column i of G, highest power first.
// All matrices are constexpr, so that laws between them are static_asserts:
//   static_assert(kBezier == product(kHermiteFromBezier, kHermite));
// Schemes of any degree, on any interval and with any nodes or knots: polynomial_basis.hpp. Curves of the
// schemes: make/named_curve.hpp.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace freiform {

template <std::size_t R, std::size_t C>
using Matrix = std::array<std::array<double, C>, R>;
using Matrix4 = Matrix<4, 4>;

template <std::size_t R, std::size_t K, std::size_t C>
constexpr Matrix<R, C> product(const Matrix<R, K>& a, const Matrix<K, C>& b) {
    Matrix<R, C> m{};
    for (std::size_t i = 0; i < R; ++i)
        for (std::size_t j = 0; j < C; ++j)
            for (std::size_t k = 0; k < K; ++k) m[i][j] += a[i][k] * b[k][j];
    return m;
}
template <std::size_t R, std::size_t C>
constexpr Matrix<C, R> transposed(const Matrix<R, C>& a) {
    Matrix<C, R> m{};
    for (std::size_t i = 0; i < R; ++i)
        for (std::size_t j = 0; j < C; ++j) m[j][i] = a[i][j];
    return m;
}
template <std::size_t R, std::size_t C>
constexpr Matrix<R, C> scaled(double s, Matrix<R, C> a) {
    for (auto& row : a)
        for (double& x : row) x *= s;
    return a;
}

// (t^3, t^2, t, 1) and its derivatives: Q' = G M (3 t^2, 2 t, 1, 0)^T.
constexpr std::array<double, 4> powers(double t) { return {t * t * t, t * t, t, 1}; }
constexpr std::array<double, 4> power_derivatives(double t) { return {3 * t * t, 2 * t, 1, 0}; }

// The four basis functions M T at T = powers(t), or their derivatives at T = power_derivatives(t).
constexpr std::array<double, 4> basis_functions(const Matrix4& m, const std::array<double, 4>& powers_of_t) {
    std::array<double, 4> b{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 4; ++k) b[i] += m[i][k] * powers_of_t[k];
    return b;
}

// The coefficient matrix itself: G = C, Q = C T.
inline constexpr Matrix4 kMonomial{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

// Hermite: G = (P1, P4, R1, R4), end points and end tangents.
inline constexpr Matrix4 kHermite{{{2, -3, 0, 1}, {-2, 3, 0, 0}, {1, -2, 1, 0}, {1, -1, 0, 0}}};

// Bezier: G = (P1, P2, P3, P4). G_H = G_B kHermiteFromBezier, that is R1 = 3 (P2 - P1), R4 = 3 (P4 - P3).
inline constexpr Matrix4 kHermiteFromBezier{{{1, 0, -3, 0}, {0, 0, 3, 0}, {0, 0, 0, -3}, {0, 1, 0, 3}}};
inline constexpr Matrix4 kBezier{{{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}};

// Kochanek and Bartels: from P2 to P3, of G = (P1, P2, P3, P4), with the tangents
//   R2 = (1-t)(1+b)(1+c)/2 (P2 - P1) + (1-t)(1-b)(1-c)/2 (P3 - P2)     leaving P2
//   R3 = (1-t)(1+b)(1-c)/2 (P3 - P2) + (1-t)(1-b)(1+c)/2 (P4 - P3)     arriving at P3
// t: tension (1: corners), c: continuity (0: smooth), b: bias (towards the side before if > 0).
struct TensionContinuityBias {
    double tension = 0, continuity = 0, bias = 0;
    friend constexpr bool operator==(const TensionContinuityBias&, const TensionContinuityBias&) = default;
};
struct TangentWeights {
    double before = 0, after = 0;  // of the differences P_i - P_{i-1} and P_{i+1} - P_i
};
constexpr TangentWeights leaving(const TensionContinuityBias& k) {
    const double s = (1 - k.tension) / 2;
    return {s * (1 + k.bias) * (1 + k.continuity), s * (1 - k.bias) * (1 - k.continuity)};
}
constexpr TangentWeights arriving(const TensionContinuityBias& k) {
    const double s = (1 - k.tension) / 2;
    return {s * (1 + k.bias) * (1 - k.continuity), s * (1 - k.bias) * (1 + k.continuity)};
}
constexpr Matrix4 kochanek_bartels_matrix(const TensionContinuityBias& at_p2,
                                          const TensionContinuityBias& at_p3) {
    const TangentWeights r2 = leaving(at_p2), r3 = arriving(at_p3);
    // G (P1 .. P4) times this is (P2, P3, R2, R3).
    const Matrix4 to_hermite{{{0, 0, -r2.before, 0},
                              {1, 0, r2.before - r2.after, -r3.before},
                              {0, 1, r2.after, r3.before - r3.after},
                              {0, 0, 0, r3.after}}};
    return product(to_hermite, kHermite);
}

// Cardinal splines: tangents (1 - tension) / 2 (P_{i+1} - P_{i-1}); Catmull-Rom: tension 0.
constexpr Matrix4 cardinal_matrix(double tension) {
    return kochanek_bartels_matrix({tension, 0, 0}, {tension, 0, 0});
}
inline constexpr Matrix4 kCatmullRom{
    {{-0.5, 1, -0.5, 0}, {1.5, -2.5, 0, 1}, {-1.5, 2, 0.5, 0}, {0.5, -0.5, 0, 0}}};

// Uniform B-splines: 6 M, whose entries are integers, and M (rounded).
inline constexpr Matrix4 kSixUniformBSpline{{{-1, 3, -3, 1}, {3, -6, 0, 4}, {-3, 3, 3, 1}, {1, 0, 0, 0}}};
inline constexpr Matrix4 kUniformBSpline{{{-1 / 6., 3 / 6., -3 / 6., 1 / 6.},
                                          {3 / 6., -1, 0, 4 / 6.},
                                          {-3 / 6., 3 / 6., 3 / 6., 1 / 6.},
                                          {1 / 6., 0, 0, 0}}};

struct NamedMatrix {
    std::string_view name, author;
    Matrix4 matrix;
};
inline constexpr std::array<NamedMatrix, 5> kNamedMatrices{{
    {"monomial", "Isaac Newton", kMonomial},
    {"hermite", "Charles Hermite", kHermite},
    {"bezier", "Pierre Bezier", kBezier},
    {"catmull-rom", "Edwin Catmull and Raphael Rom", kCatmullRom},
    {"uniform-b-spline", "Isaac Schoenberg", kUniformBSpline},
}};

// Halves of a cubic at t = 1/2: G times the left one are the control points on [0, 1/2], the right one on
// [1/2, 1].
inline constexpr Matrix4 kBezierLeftHalf =
    scaled(1 / 8., Matrix4{{{8, 4, 2, 1}, {0, 4, 4, 3}, {0, 0, 2, 3}, {0, 0, 0, 1}}});
inline constexpr Matrix4 kBezierRightHalf =
    scaled(1 / 8., Matrix4{{{1, 0, 0, 0}, {3, 2, 0, 0}, {3, 4, 4, 0}, {1, 2, 4, 8}}});
// The uniform cubic B-spline of one segment as two: columns 0 .. 3 are the control points of the first, 1 ..
// 4 of the second.
inline constexpr Matrix<4, 5> kUniformBSplineHalves =
    scaled(1 / 8., Matrix<4, 5>{{{4, 1, 0, 0, 0}, {4, 6, 4, 1, 0}, {0, 1, 4, 6, 4}, {0, 0, 0, 1, 4}}});

static_assert(kBezier == product(kHermiteFromBezier, kHermite));
static_assert(kCatmullRom == cardinal_matrix(0));

}  // namespace freiform
