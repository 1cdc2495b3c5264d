// Triangular Bezier patches by de Casteljau's algorithm.
//
// Idea: the blossom of a triangular patch at n points of its plane is found by n steps, each of which
// replaces the net of degree m by one of degree m - 1,
//     b'_ijk = t1 b_{i+1,j,k} + t2 b_{i,j+1,k} + t3 b_{i,j,k+1},
// for the barycentric coordinates t of one argument. Equal arguments: a value. Directions (e2 - e1 for u, e3
// - e1 for v) as arguments, times n (n-1) ..: derivatives. The corners of another triangle as arguments: the
// coefficients over that triangle [Farin 2002, ch. 17], [Ramshaw 1989].
//
// Notation: rows r = j + k = 0..m, position k in the row; slot r (r + 1) / 2 + k does not depend on the
// degree, so a step reads (r, k), (r + 1, k), (r + 1, k + 1) and writes (r, k): it works in place in
// ascending order.
//
// Accuracy of values. u = 2^-53, n the degree, c = max |P_i|, inside the triangle. A step is three products
// and two sums of terms whose absolute values add up to at most c: 3 roundings, 3 n in all. The given
// parameters are u and v; t1 is computed with an error of at most u (two roundings of numbers below 1, or the
// rounding of u + v to 1), which moves the value by at most n u c. Products that underflow lose 3 n denormal
// numbers h. Together
//     1.01 (3 n + n) u c + 3 n h.
// Rational: numerator and denominator suffer 3 n roundings relative to the weighted terms, hence 2 (1.01 3 n
// u) c as for tensor products, and n u w_max (c and 1) from t1, hence 2 (1.01 n u) c w_max / w_min, and one
// more rounding.
//
// Why not the form of Horner: it is O(n^2) a point instead of O(n^3), but loses the bound near corners.
#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/spline/simplex.hpp>
#include <freiform/spline/simplex_convert.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

namespace {

constexpr int kMaxCoefficients = (kMaxDegree + 1) * (kMaxDegree + 2) / 2;
using Barycentric = std::array<double, 3>;
constexpr Barycentric kCorner[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

constexpr int count_for(int degree) { return (degree + 1) * (degree + 2) / 2; }

// One step of de Casteljau: the net b of degree m becomes one of degree m - 1.
template <class P>
void step(P* b, int m, const Barycentric& t) {
    const P* next = b + 1;  // row r + 1
    for (int r = 0; r < m; ++r, ++next)
        for (int k = 0; k <= r; ++k, ++b, ++next)
            for (int c = 0; c < P::kCoords; ++c)
                (*b)[c] = t[0] * (*b)[c] + t[1] * next[0][c] + t[2] * next[1][c];
}

// The same with the direction towards corner 2 (which = 0, u) or corner 3 (which = 1, v) as argument.
template <class P>
void difference(P* b, int m, int which) {
    const P* next = b + 1;
    for (int r = 0; r < m; ++r, ++next)
        for (int k = 0; k <= r; ++k, ++b, ++next) *b = next[which] - *b;
}

// A copy of a net that is changed in place.
template <class P>
struct Scratch {
    P b[kMaxCoefficients];
    void operator=(std::span<const P> from) { std::copy(from.begin(), from.end(), b); }
    std::span<const P> net(int degree) const { return {b, std::size_t(count_for(degree))}; }
};

template <class P>
struct Extent {
    double c = 0, w_min = std::numeric_limits<double>::infinity(), w_max = 0;
    explicit Extent(std::span<const P> net) {
        for (const P& p : net) {
            c = std::max(c, max_abs(project(p)));
            w_min = std::min(w_min, Space<P>::weight(p));
            w_max = std::max(w_max, Space<P>::weight(p));
        }
    }
};

}  // namespace

template <std::size_t N, Coefficient P>
Result<SimplexPatch<N, P>> SimplexPatch<N, P>::make(int degree, std::vector<P> coefficients) {
    if (degree < 0 || degree > kMaxDegree)
        return refuse(degree < 0 ? RefusalKind::invalid : RefusalKind::unsupported, "degree",
                      text("degree ", degree, " is outside 0..", kMaxDegree));
    if (coefficients.size() != std::size_t(count_for(degree)))
        return refuse(RefusalKind::invalid, "points",
                      text(coefficients.size(), " coefficients, a triangle of degree ", degree, " has ",
                           count_for(degree)));
    // The checks of single coefficients are those of a curve with the same ones.
    const int size = int(coefficients.size());
    if (auto basis = BSplineBasis::clamped_uniform(0, size); !basis)
        return std::unexpected(basis.error());
    else if (auto ok = Curve<P>::make({*basis}, Net<1, P>({size}, coefficients)); !ok)
        return std::unexpected(ok.error());
    return SimplexPatch(degree, std::move(coefficients));
}

template <std::size_t N, Coefficient P>
std::array<double, 3> SimplexPatch<N, P>::barycentric(const Param<2>& u) {
    const double t1 = (1 - u[0]) - u[1];
    return {contains(u) ? std::max(t1, 0.0) : t1, u[0], u[1]};
}

template <std::size_t N, Coefficient P>
Result<void> SimplexPatch<N, P>::check(const Param<2>& u, std::size_t index) const {
    for (std::size_t d = 0; d < 2; ++d)
        if (!std::isfinite(u[d]))
            return refuse(RefusalKind::nonfinite, text("at[", index, "][", d, "]"),
                          text(u[d], " is not a finite number"));
    if (!contains(u))
        return refuse(RefusalKind::out_of_domain, text("at[", index, "]"),
                      text("(", u[0], ", ", u[1], ") is outside the triangle u >= 0, v >= 0, u + v <= 1"));
    return {};
}

template <std::size_t N, Coefficient P>
Result<void> SimplexPatch<N, P>::evaluate(std::span<const Param<2>> at, std::span<Point> out) const {
    FF_REQUIRE(at.size() == out.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (auto ok = check(at[i], i); !ok) return ok;
        out[i] = (*this)(at[i]);
    }
    return {};
}

template <std::size_t N, Coefficient P>
typename SimplexPatch<N, P>::Point SimplexPatch<N, P>::at_barycentric(const std::array<double, 3>& t) const {
    Scratch<P> s;
    s = coefficients();
    for (int m = degree_; m > 0; --m) step(s.b, m, t);
    return project(s.b[0]);
}

template <std::size_t N, Coefficient P>
void SimplexPatch<N, P>::partials(const Param<2>& u, int order, std::span<Point> out) const {
    const Barycentric t = barycentric(u);
    std::vector<P> h(jet_size(2, order));
    Scratch<P> by_u, by_v, value;
    by_u = coefficients();
    double factor_u = 1;
    for (int a = 0; a <= std::min(order, degree_); ++a) {
        by_v = by_u.net(degree_ - a);
        double factor = factor_u;
        for (int b = 0; a + b <= std::min(order, degree_); ++b) {
            const int m = degree_ - a - b;
            value = by_v.net(m);
            for (int k = m; k > 0; --k) step(value.b, k, t);
            h[jet_slot<2>({a, b})] = factor * value.b[0];
            if (m > 0) difference(by_v.b, m, 1);
            factor *= m;
        }
        if (a < degree_) difference(by_u.b, degree_ - a, 0);
        factor_u *= degree_ - a;
    }
    project_jet<2, P>(order, h, out);
}

template <std::size_t N, Coefficient P>
std::vector<typename SimplexPatch<N, P>::Point> SimplexPatch<N, P>::derivatives(const Param<2>& u,
                                                                                int order) const {
    std::vector<Point> out(jet_size(2, order));
    partials(u, order, out);
    return out;
}

template <std::size_t N, Coefficient P>
double SimplexPatch<N, P>::value_error_bound() const {
    const Extent<P> e(coefficients());
    const double lost = (3 * degree_ + 1) * std::numeric_limits<double>::denorm_min(),
                 g = 1.01 * degree_ * kUnitRoundoff;
    if (!Space<P>::kRational) return 4 * g * e.c + lost;
    const double spread = e.w_max / e.w_min;
    return 1.02 * ((6 * g + 2 * g * spread + kUnitRoundoff) * e.c + (1 + e.c) * (lost / e.w_min)) + lost;
}

template <class P>
Result<SimplexPatch<2, P>> elevate(const SimplexPatch<2, P>& s) {
    const int n = s.degree() + 1;
    if (n > kMaxDegree)
        return refuse(RefusalKind::unsupported, "degree", text("degree ", n, " is outside 0..", kMaxDegree));
    std::vector<P> out;
    for (int r = 0; r <= n; ++r)
        for (int k = 0; k <= r; ++k) {
            const int j = r - k, i = n - r;
            P sum{};
            if (i > 0) sum += double(i) / n * s.coefficient(j, k);
            if (j > 0) sum += double(j) / n * s.coefficient(j - 1, k);
            if (k > 0) sum += double(k) / n * s.coefficient(j, k - 1);
            out.push_back(sum);
        }
    return SimplexPatch<2, P>::trusted(n, std::move(out));
}

namespace {

// Coefficients over another triangle. The corners are taken in an order that depends on where they are and
// not on their numbers, so parts that share an edge have the same bits along it.
template <class P>
SimplexPatch<2, P> over(const SimplexPatch<2, P>& s, const std::array<Barycentric, 3>& corner) {
    const int n = s.degree();
    std::array<std::size_t, 3> order{0, 1, 2};
    sort(order.begin(), order.end(), [&](auto x, auto y) { return corner[x] < corner[y]; });
    std::vector<P> out(s.coefficients().size());
    Scratch<P> first, second, third;
    first = s.coefficients();
    for (int a = 0; a <= n; ++a) {  // `first`: a arguments are the first corner
        second = first.net(n - a);
        for (int b = 0; a + b <= n; ++b) {  // `second`: and b are the second
            const int c = n - a - b;
            third = second.net(c);
            for (int m = c; m > 0; --m) step(third.b, m, corner[order[2]]);
            std::array<int, 3> power{};
            power[order[0]] = a, power[order[1]] = b, power[order[2]] = c;
            out[SimplexPatch<2, P>::slot(power[1], power[2])] = third.b[0];
            if (c > 0) step(second.b, c, corner[order[1]]);
        }
        if (a < n) step(first.b, n - a, corner[order[0]]);
    }
    return SimplexPatch<2, P>::trusted(n, std::move(out));
}

}  // namespace

template <class P>
SimplexPatch<2, P> restrict_to(const SimplexPatch<2, P>& s, const std::array<Param<2>, 3>& corners) {
    using S = SimplexPatch<2, P>;
    return over(s, {S::barycentric(corners[0]), S::barycentric(corners[1]), S::barycentric(corners[2])});
}

template <class P>
SimplexPatch<2, P> restrict_to(const SimplexPatch<2, P>& s,
                               const std::array<std::array<double, 3>, 3>& corners) {
    return over(s, corners);
}

template <class P>
std::array<SimplexPatch<2, P>, 3> split_at(const SimplexPatch<2, P>& s, const Param<2>& u) {
    const Barycentric t = s.barycentric(u);
    return {over(s, {t, kCorner[1], kCorner[2]}), over(s, {kCorner[0], t, kCorner[2]}),
            over(s, {kCorner[0], kCorner[1], t})};
}

template <class P>
std::array<SimplexPatch<2, P>, 4> split_in_four(const SimplexPatch<2, P>& s) {
    constexpr Barycentric m23{0, 0.5, 0.5}, m31{0.5, 0, 0.5}, m12{0.5, 0.5, 0};
    return {over(s, {kCorner[0], m12, m31}), over(s, {m12, kCorner[1], m23}), over(s, {m31, m23, kCorner[2]}),
            over(s, {m23, m31, m12})};
}

template <class P>
Curve<P, Bernstein> boundary(const SimplexPatch<2, P>& s, int edge) {
    const int n = s.degree();
    Net<1, P> net({n + 1});
    for (int a = 0; a <= n; ++a)
        net.flat()[std::size_t(a)] = edge == 0   ? s.coefficient(n - a, a)
                                     : edge == 1 ? s.coefficient(0, n - a)
                                                 : s.coefficient(a, 0);
    return Curve<P, Bernstein>::trusted({*Bernstein::make(n)}, std::move(net));
}

template <class P>
requires(Space<P>::kDim == 3) Result<Vec<3>> normal(const SimplexPatch<2, P>& s, const Param<2>& u) {
    Jet<2, 1, Vec<3>> j;
    if (auto ok = s.template evaluate<1>(std::span(&u, 1), std::span(&j, 1)); !ok)
        return std::unexpected(ok.error());
    // Error of a first derivative, coordinate by coordinate. A difference net has coefficients up to 2 c with
    // one rounding and degree n - 1: n (4 (n - 1) + 3) 2 u c < 8.1 n^2 u c. Rational, with q = w_max / w_min:
    // twice that times q for numerator and denominator, |W_u| <= n w_max times the error of the value, which
    // is below 10.3 n q u c, and the roundings of the quotient: below 35 n^2 q^2 u c.
    const Extent<P> e(s.coefficients());
    const double n = s.degree(), q = e.w_max / e.w_min,
                 error = 64 * (n * n + 1) * q * q * kUnitRoundoff * e.c;
    const Vec<3>&a = j(1, 0), &b = j(0, 1), product = cross(a, b);
    const double ma = max_abs(a), mb = max_abs(b);
    if (!(max_abs(product) > 2 * error * (ma + mb + error) + 8 * kUnitRoundoff * ma * mb))
        return refuse(RefusalKind::ill_conditioned, "normal",
                      text("the derivatives by u and v at (", u[0], ", ", u[1],
                           ") are parallel or zero within rounding"));
    return unit(product);
}

#define FF_SIMPLEX_OF(P)                                                                                \
    template class SimplexPatch<2, P>;                                                                  \
    template Result<SimplexPatch<2, P>> elevate(const SimplexPatch<2, P>&);                             \
    template SimplexPatch<2, P> restrict_to(const SimplexPatch<2, P>&, const std::array<Param<2>, 3>&); \
    template SimplexPatch<2, P> restrict_to(const SimplexPatch<2, P>&,                                  \
                                            const std::array<std::array<double, 3>, 3>&);               \
    template std::array<SimplexPatch<2, P>, 3> split_at(const SimplexPatch<2, P>&, const Param<2>&);    \
    template std::array<SimplexPatch<2, P>, 4> split_in_four(const SimplexPatch<2, P>&);                \
    template Curve<P, Bernstein> boundary(const SimplexPatch<2, P>&, int);
FF_SIMPLEX_OF(Vec<1>)
FF_SIMPLEX_OF(Vec<2>)
FF_SIMPLEX_OF(Vec<3>)
FF_SIMPLEX_OF(Vec<4>)
FF_SIMPLEX_OF(Hom<1>)
FF_SIMPLEX_OF(Hom<2>)
FF_SIMPLEX_OF(Hom<3>)
FF_SIMPLEX_OF(Hom<4>)
#undef FF_SIMPLEX_OF
template Result<Vec<3>> normal(const SimplexPatch<2, Vec<3>>&, const Param<2>&);
template Result<Vec<3>> normal(const SimplexPatch<2, Hom<3>>&, const Param<2>&);

}  // namespace freiform
