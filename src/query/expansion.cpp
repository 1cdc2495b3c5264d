// A curve in arc length, at regular points and where its derivative is 0.
//
// Notation: r the order of the first derivative that is not 0, u the parameter counted from the joint into
// the side, c(u) = c_r u^r + .. less the point, c' = u^(r-1) d(u), d(0) != 0; s the arc length counted into
// the side.
//
// Method, r = 1: s(u) = integral |c'| as a power series, its inverse, and the composition of both.
//
// r > 1: |c'| = u^(r-1) rho(u) with rho = |d| > 0, so s = s_0 u^r f(u), s_0 = rho(0) / r, f(0) = 1, and x =
// (s / s_0)^(1/r) = u f^(1/r) is a regular parameter: c = sum C_j x^j is a series in the r-th root of the arc
// length. By Lagrange's inversion, with [..]_m the m-th term,
//     C_j = [c' f^(-j/r)]_(j-1) / j = [d f^(-j/r)]_(j-r) / j.
// The derivative of order k by arc length has a limit if and only if C_j = 0 for all j < k r that are no
// multiples of r, and then it is k! C_(k r) / s_0^k. So (t^2, t^3) has no curvature at 0 (C_3 is not 0), and
// (t^2, t^4) has: it is a parabola. Derivatives of order below r, which are 0 as far as is known, are taken
// for 0; bounds are those of such curves.
//
// Before a joint u = -t, and derivatives of odd order by arc length change their sign.
//
// Cost: O(n^4) for n terms if r = 1, else O((r n)^3). References: [Knuth 1997, 4.7] for powers and inversion.
#include "expansion_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform::detail {

namespace {

std::size_t orders_of(const CurveSide& s) { return s.derivatives.size() / std::size_t(s.dimension); }

// Terms of a coordinate in scaled units, the constant one left out.
Series<Bounded> terms_of(const CurveSide& side, int c, std::size_t terms, int time, int length_scale) {
    std::vector<Bounded> d;
    for (std::size_t k = 0; k < terms; ++k)
        d.push_back(scaled(side.derivatives[k * std::size_t(side.dimension) + std::size_t(c)],
                           int(k) * time - length_scale));
    d[0] = Bounded(0);
    return series_of(std::span<const Bounded>(d));
}

void add_square(Series<Bounded>& sum, const Series<Bounded>& x) {
    const Series<Bounded> part = multiply(x, x);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
}

void expand_regular(Expansion& x, const CurveSide& side, std::size_t terms, int length_scale) {
    Series<Bounded> square(terms - 1);
    std::vector<Series<Bounded>> point;
    for (int c = 0; c < side.dimension; ++c) {
        point.push_back(terms_of(side, c, terms, x.time, length_scale));
        add_square(square, differentiated(point.back()));
    }
    x.arc = integrated(square_root(square));
    const Series<Bounded> back = inverse(x.arc);
    for (const auto& c : point) x.by_length.push_back(compose(c, back));
}

// Order by order, as long as derivatives by arc length have limits.
void expand_singular(Expansion& x, const CurveSide& side, std::size_t orders, int length_scale, bool after,
                     double tolerance) {
    const std::size_t r = std::size_t(x.first), dimension = std::size_t(side.dimension),
                      terms = std::min(orders_of(side), (orders - 1) * r + 1);
    if (terms <= r) return;
    std::vector<Series<Bounded>> d;
    Series<Bounded> square(terms - r);
    for (int c = 0; c < side.dimension; ++c) {
        Series<Bounded> point = terms_of(side, c, terms, x.time, length_scale);
        for (std::size_t k = 1; k < terms && !after; k += 2) point[k] = -point[k];
        point = differentiated(point);
        d.emplace_back(point.begin() + std::ptrdiff_t(r) - 1, point.end());
        add_square(square, d.back());
    }
    Series<Bounded> f = square_root(square);
    for (std::size_t k = 0; k < f.size(); ++k) f[k] = f[k] / Bounded(double(r + k));
    const Bounded unit_length = f[0];
    for (Bounded& k : f) k = k / unit_length;
    f[0] = Bounded(1);

    x.by_length.assign(dimension, {Bounded(0)});
    const double reach = std::scalbn(side.reach, -length_scale) / unit_length.value;
    Bounded scale(1);  // s_0^-k, with the sign of the side
    for (std::size_t j = r; j < terms; ++j) {
        const Series<Bounded> power = power_of(f, -int(j), int(r));
        BoundedVector term(dimension);
        for (std::size_t c = 0; c < dimension; ++c) {
            for (std::size_t i = 0; i + r <= j; ++i) term[c] += d[c][i] * power[j - r - i];
            term[c] = term[c] / Bounded(double(j));
        }
        const Bounded size = length(term);
        if (!size.is_finite()) return;  // nothing is known from here on
        if (j % r == 0) {
            scale = (after ? scale : -scale) / unit_length;
            for (std::size_t c = 0; c < dimension; ++c) x.by_length[c].push_back(term[c] * scale);
            continue;
        }
        const double moved = std::scalbn(size.value * std::pow(reach, double(j) / double(r)), length_scale);
        if (size.value <= size.bound || moved <= tolerance) continue;
        x.unbounded = int(j / r) + 1;
        return;
    }
}

}  // namespace

// Lengths differ by at most the length of the difference.
Bounded length(const BoundedVector& v) {
    double most = 0;
    for (const Bounded& x : v) {
        if (!x.is_finite()) return {kInfinity, kInfinity};
        most = std::max({most, std::abs(x.value), x.bound});
    }
    if (most == 0) return {};
    const int e = std::ilogb(most);
    double sum = 0, slack = 0;
    for (const Bounded& x : v) {
        const double a = std::scalbn(x.value, -e), b = std::scalbn(x.bound, -e);
        sum += a * a;
        slack += b * b;
    }
    const double size = std::sqrt(sum);
    return scaled(Bounded(size, detail::above(std::sqrt(slack) +
                                              double(v.size() + 2) * kUnitRoundoff * (sum == 0 ? 0 : size))),
                  e);
}
Bounded inner(const BoundedVector& a, const BoundedVector& b) {
    Bounded sum;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}
BoundedVector unit(const BoundedVector& v) {
    double most = 0;
    for (const Bounded& x : v) {
        if (!x.is_finite()) return {};
        most = std::max(most, std::abs(x.value));
    }
    if (most == 0) return {};
    BoundedVector u = v;
    for (Bounded& x : u) x = scaled(x, -std::ilogb(most));
    const Bounded square = inner(u, u);
    if (!square.excludes_zero()) return {};
    const Bounded l = sqrt(square);
    for (Bounded& x : u) x = x / l;
    return u;
}

BoundedVector derivative_of(const CurveSide& s, std::size_t k) {
    const auto first = s.derivatives.begin() + std::ptrdiff_t(k) * s.dimension;
    return {first, first + s.dimension};
}

int first_order(const CurveSide& side) {
    for (std::size_t k = 1; k < orders_of(side); ++k)
        if (!unit(derivative_of(side, k)).empty()) return int(k);
    return 0;
}

BoundedVector Expansion::derivative(std::size_t k) const {
    double factorial = 1;
    for (std::size_t i = 2; i <= k; ++i) factorial *= double(i);
    BoundedVector v;
    for (const auto& x : by_length) v.push_back(x[k] * Bounded(factorial));
    return v;
}

Expansion expand(const CurveSide& side, std::size_t terms, int length_scale, bool after, double tolerance) {
    Expansion x;
    x.dimension = side.dimension;
    x.time = side.span > 0 ? std::ilogb(side.span) : 0;
    x.first = first_order(side);
    if (x.first == 0) return x;
    BoundedVector v = derivative_of(side, std::size_t(x.first));
    if (!after && x.first % 2 == 0)
        for (Bounded& c : v) c = -c;
    x.tangent = unit(v);
    if (terms < 2) return x;
    if (x.is_regular())
        expand_regular(x, side, terms, length_scale);
    else
        expand_singular(x, side, terms, length_scale, after, tolerance);
    return x;
}

}  // namespace freiform::detail
