// Points and displacements of D coordinates. One type serves both: an affine combination and a difference
// are told apart by the formula, not by the type.
#pragma once
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>

namespace freiform {

template <int D>
struct Vec {
    static constexpr int kCoords = D;
    std::array<double, std::size_t(D)> c{};

    constexpr double& operator[](int i) { return c[std::size_t(i)]; }
    constexpr double operator[](int i) const { return c[std::size_t(i)]; }
    friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

// A coefficient is a tuple of doubles with the operations of a real vector space.
template <class P>
concept Coefficient = requires(P p) {
    { P::kCoords } -> std::convertible_to<int>;
    { p[0] } -> std::convertible_to<double>;
    p.c;
};

// The same coefficients as plain numbers, P::kCoords for each: for what treats every coordinate alike.
template <class P>
requires Coefficient<std::remove_const_t<P>>
auto numbers(std::span<P> all) {
    using Number = std::conditional_t<std::is_const_v<P>, const double, double>;
    static_assert(sizeof(P) == std::size_t(P::kCoords) * sizeof(double));
    if (all.empty()) return std::span<Number>();
    Number* first = all.data()->c.data();
    return std::span<Number>(first, all.size() * std::size_t(P::kCoords));
}

template <Coefficient P>
constexpr P& operator+=(P& a, const P& b) {
    for (int i = 0; i < P::kCoords; ++i) a[i] += b[i];
    return a;
}
template <Coefficient P>
constexpr P& operator-=(P& a, const P& b) {
    for (int i = 0; i < P::kCoords; ++i) a[i] -= b[i];
    return a;
}
template <Coefficient P>
constexpr P& operator*=(P& a, double s) {
    for (int i = 0; i < P::kCoords; ++i) a[i] *= s;
    return a;
}
template <Coefficient P>
constexpr P operator+(P a, const P& b) {
    return a += b;
}
template <Coefficient P>
constexpr P operator-(P a, const P& b) {
    return a -= b;
}
template <Coefficient P>
constexpr P operator-(P a) {
    return a *= -1.0;
}
template <Coefficient P>
constexpr P operator*(double s, P a) {
    return a *= s;
}
template <Coefficient P>
constexpr double dot(const P& a, const P& b) {
    double s = 0;
    for (int i = 0; i < P::kCoords; ++i) s += a[i] * b[i];
    return s;
}
template <Coefficient P>
constexpr double max_abs(const P& a) {
    double m = 0;
    for (int i = 0; i < P::kCoords; ++i) m = a[i] > m ? a[i] : -a[i] > m ? -a[i] : m;
    return m;
}

namespace detail {
// Whether roots of squared lengths are as exact as they are of numbers near 1.
constexpr bool is_plain_square(double s) { return s > 1e-280 && s < 1e280; }

// The length of a vector whose square is too large or too small for numbers.
template <Coefficient P>
[[gnu::noinline]] double scaled_norm(const P& a) {
    const double m = max_abs(a);
    if (m == 0 || !std::isfinite(m)) return m;
    const int e = std::ilogb(m);
    P b = a;
    for (int i = 0; i < P::kCoords; ++i) b[i] = std::scalbn(b[i], -e);
    return std::scalbn(std::sqrt(dot(b, b)), e);
}
}  // namespace detail

// Euclidean length. Neither overflows nor underflows on the way, and scales exactly with powers of two.
template <Coefficient P>
double norm(const P& a) {
    const double s = dot(a, a);
    return detail::is_plain_square(s) ? std::sqrt(s) : detail::scaled_norm(a);
}

template <Coefficient P>
constexpr bool is_finite(const P& a) {
    for (int i = 0; i < P::kCoords; ++i)
        if (!(a[i] - a[i] == 0)) return false;
    return true;
}

constexpr Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
constexpr double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

// The vector of length 1 with the direction of `a`; zero if `a` is zero.
template <int D>
Vec<D> unit(const Vec<D>& a) {
    const double s = dot(a, a);
    if (detail::is_plain_square(s)) return (1 / std::sqrt(s)) * a;
    const double m = max_abs(a);
    if (m == 0) return a;
    const int e = std::ilogb(m);
    Vec<D> b;
    for (int i = 0; i < D; ++i) b[i] = std::scalbn(a[i], -e);
    return (1 / std::sqrt(dot(b, b))) * b;
}

}  // namespace freiform
