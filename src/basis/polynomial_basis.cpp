// Changes between polynomial bases of any degree.
//
// Idea: every basis is known by its functions (their coefficients in one common basis) or by its functionals
// (what its coefficients are of a given polynomial). A change is then one product or one solution of linear
// equations. Done in 512 binary digits with a running bound, the method need not be a stable one: what it
// loses, even 1e40, is far below a double, and the bound says so by itself.
//
// Notation: n degree; the common basis are the powers (t - o)^k, o a number of the target basis; V the matrix
// whose column j is function j; L the matrix whose row i are the values of functional i on the powers, L =
// V^-1.
//
// Method: functions: monomial (binomials), Newton (products), Bernstein and B-spline (derivatives at o by the
// recurrence of blossom.hpp, divided by k!). Functionals: Lagrange (values), Hermite (derivatives at the
// ends). A = L_to V_from; where L_to or V_from is not at hand, Gaussian elimination with row pivoting solves
// V_to A = V_from or L_from V_from = I.
//
// Cost: O(n^3) operations of about a microsecond: 5 to 100 ms at degree 25, the inverse included.
//
// Accuracy: entries are the doubles nearest to the middles of balls that contain the exact ones
// (ball_detail.hpp); a ball is so small that an entry is the nearest double but for ties. map() in double
// precision: with |e_ij| <= error, fl(sum_j a_ij c_j) differs from the exact sum by at most sum_j (e_ij + g
// |a_ij|) |c_j|, g = (n + 3) u / (1 - (n + 3) u) for n + 1 products and sums [Higham 2002, ch. 3]. That is
// absolute_loss; and max |c| <= |A^-1| max |d|.
//
// References: [Farouki & Rajan 1987], [Ramshaw 1989], [Higham 2002].
//
// Why not closed forms: with seven kinds of bases there are 42 pairs, each with its own formula, rounding
// analysis and test. Why not double-double: the condition of equidistant Lagrange against monomial is 1e20 at
// degree 25. Why not rationals: they are exact, but with arbitrary nodes have ten thousands of digits.
#include "basis/ball_detail.hpp"

#include <freiform/basis/polynomial_basis.hpp>
#include <freiform/core/constants.hpp>

#include <algorithm>

namespace freiform {

using detail::Ball;

std::string_view name_of(Scheme scheme) {
    constexpr std::string_view kNames[] = {"monomial", "bernstein", "hermite",
                                           "lagrange", "newton",    "b-spline"};
    return kNames[int(scheme)];
}

std::vector<double> equidistant(int n, Interval on) {
    std::vector<double> x;
    if (n == 1) return {on.middle()};
    for (int i = 0; i < n; ++i) {
        const double a = double(i) / (n - 1);
        x.push_back(i + 1 == n ? on.hi : (1 - a) * on.lo + a * on.hi);
    }
    return x;
}

Result<PolynomialBasis> PolynomialBasis::checked(PolynomialBasis b) {
    if (b.degree_ < 0 || b.degree_ > kMaxDegree)
        return refuse(RefusalKind::unsupported, "degree",
                      text("degree ", b.degree_, " is outside [0, ", kMaxDegree, "]"));
    for (std::size_t i = 0; i < b.numbers_.size(); ++i)
        if (!std::isfinite(b.numbers_[i]))
            return refuse(RefusalKind::nonfinite, text(name_of(b.scheme_), "[", i, "]"),
                          text(b.numbers_[i], " is not a finite number"));
    return b;
}

namespace {

Result<void> check_interval(Interval on) {
    if (!(on.lo < on.hi) || !std::isfinite(on.length()))
        return refuse(RefusalKind::invalid, "interval",
                      text("[", on.lo, ", ", on.hi, "] is empty or not finite"));
    return {};
}

}  // namespace

Result<PolynomialBasis> PolynomialBasis::monomial(int degree, double origin) {
    return checked({Scheme::monomial, degree, {origin}});
}

Result<PolynomialBasis> PolynomialBasis::bernstein(int degree, Interval on) {
    if (auto ok = check_interval(on); !ok) return std::unexpected(ok.error());
    if (degree < 0 || degree > kMaxDegree) return checked({Scheme::bernstein, degree, {}});
    std::vector<double> t(2 * std::size_t(degree) + 2, on.lo);
    std::fill(t.begin() + degree + 1, t.end(), on.hi);
    return checked({Scheme::bernstein, degree, std::move(t)});
}

Result<PolynomialBasis> PolynomialBasis::hermite(int degree, Interval on) {
    if (auto ok = check_interval(on); !ok) return std::unexpected(ok.error());
    if (degree % 2 == 0)
        return refuse(RefusalKind::unsupported, "degree",
                      text("degree ", degree,
                           " is even; a Hermite basis with as many derivatives at both ends has "
                           "an odd degree"));
    return checked({Scheme::hermite, degree, {on.lo, on.hi}});
}

Result<PolynomialBasis> PolynomialBasis::lagrange(std::vector<double> nodes) {
    const int degree = int(std::min<std::size_t>(nodes.size(), 1000)) - 1;
    auto b = checked({Scheme::lagrange, degree, std::move(nodes)});
    if (!b) return b;
    for (int i = 0; i <= degree; ++i)
        for (int j = 0; j < i; ++j)
            if (b->knot(i) == b->knot(j))
                return refuse(RefusalKind::invalid, text("lagrange[", i, "]"),
                              text("the node ", b->knot(i), " is also node ", j, "; all must be different"));
    return b;
}

Result<PolynomialBasis> PolynomialBasis::newton(std::vector<double> nodes) {
    const int degree = int(std::min<std::size_t>(nodes.size(), 1000)) - 1;
    return checked({Scheme::newton, degree, std::move(nodes)});
}

Result<PolynomialBasis> PolynomialBasis::uniform_b_spline(int degree) {
    if (degree < 0 || degree > kMaxDegree) return checked({Scheme::b_spline, degree, {}});
    std::vector<double> t;
    for (int i = -degree; i <= degree + 1; ++i) t.push_back(i);
    return checked({Scheme::b_spline, degree, std::move(t)});
}

Result<PolynomialBasis> PolynomialBasis::b_spline(const BSplineBasis& basis, int span) {
    const int p = basis.degree();
    if (span < p || span + p + 1 >= int(basis.knots().size()) || basis.knot(span) == basis.knot(span + 1))
        return refuse(RefusalKind::out_of_domain, "span",
                      text("span ", span, " is empty or outside the domain"));
    const auto t = basis.knots().subspan(std::size_t(span - p), 2 * std::size_t(p) + 2);
    return checked({Scheme::b_spline, p, {t.begin(), t.end()}});
}

namespace {

// Two-ended Hermite functions of degree 2 m + 1: with s = (t - lo) / h,
//   H_r = h^r s^r / r! (1 - s)^(m+1) sum_{k=0}^{m-r} C(m + k, k) s^k
// (the Taylor polynomial of s^r / r! (1 - s)^-(m+1), so that the product has the right derivatives at lo),
// and at hi the same mirrored, with the sign (-1)^r.
std::vector<double> hermite_values(int degree, double lo, double hi, double t) {
    const int m = (degree - 1) / 2;
    const double h = hi - lo;
    std::vector<double> f(std::size_t(degree) + 1);
    for (int side = 0; side < 2; ++side) {
        const double s = side == 0 ? (t - lo) / h : (hi - t) / h,
                     away = side == 0 ? (hi - t) / h : (t - lo) / h;
        double factor = 1;
        for (int k = 0; k <= m; ++k) factor *= away;
        for (int r = 0; r <= m; ++r) {
            double sum = 0, term = 1;
            for (int k = 0; k <= m - r; ++k) {
                sum += term;
                term *= s * (m + k + 1) / (k + 1);
            }
            f[std::size_t(2 * r + side)] = factor * sum;
            factor *= (side == 0 ? h : -h) * s / (r + 1);
        }
    }
    return f;
}

}  // namespace

std::vector<double> PolynomialBasis::values(double t) const {
    const std::size_t n = std::size_t(size());
    std::vector<double> f(n, 1.0);
    switch (scheme_) {
        case Scheme::monomial:
            for (std::size_t j = n - 1; j-- > 0;) f[j] = f[j + 1] * (t - numbers_[0]);
            break;
        case Scheme::newton:
            for (std::size_t j = 1; j < n; ++j) f[j] = f[j - 1] * (t - numbers_[j - 1]);
            break;
        case Scheme::lagrange:
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t k = 0; k < n; ++k)
                    if (k != j) f[j] *= (t - numbers_[k]) / (numbers_[j] - numbers_[k]);
            break;
        case Scheme::hermite:
            return hermite_values(degree_, numbers_[0], numbers_[1], t);
        case Scheme::bernstein:
        case Scheme::b_spline:
            weights_in_span(*this, degree_, t, 0, f.data());
            break;
    }
    return f;
}

namespace {

// A square or rectangular matrix of balls, row-major.
struct Table {
    int rows = 0, cols = 0;
    std::vector<Ball> a;
    Table(int r, int c) : rows(r), cols(c), a(std::size_t(r) * std::size_t(c)) {}
    Ball& operator()(int i, int j) { return a[std::size_t(i * cols + j)]; }
    const Ball& operator()(int i, int j) const { return a[std::size_t(i * cols + j)]; }
};

Table identity(int n) {
    Table m(n, n);
    for (int i = 0; i < n; ++i) m(i, i) = Ball(1);
    return m;
}

Table product(const Table& a, const Table& b) {
    Table m(a.rows, b.cols);
    for (int i = 0; i < a.rows; ++i)
        for (int k = 0; k < a.cols; ++k) {
            if (a(i, k).is_zero()) continue;
            for (int j = 0; j < b.cols; ++j)
                if (!b(k, j).is_zero()) m(i, j) += a(i, k) * b(k, j);
        }
    return m;
}

Table transposed(const Table& a) {
    Table m(a.cols, a.rows);
    for (int i = 0; i < a.rows; ++i)
        for (int j = 0; j < a.cols; ++j) m(j, i) = a(i, j);
    return m;
}

// x of a x = b, by Gauss-Jordan elimination with row pivoting. Where a may be singular, entries get radii
// that are not finite.
Table solution(Table a, Table b) {
    const int n = a.rows;
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k; i < n; ++i) {
            const Ball &x = a(i, k), &best = a(pivot, k);
            if (x.m.sign() != 0 && (best.m.sign() == 0 || x.magnitude() > best.magnitude())) pivot = i;
        }
        for (int j = 0; j < n; ++j) std::swap(a(k, j), a(pivot, j));
        for (int j = 0; j < b.cols; ++j) std::swap(b(k, j), b(pivot, j));
        const Ball inverse = Ball(1) / a(k, k);
        const bool one = a(k, k).r == 0 && a(k, k).e == 0 && a(k, k).m == detail::integer(1);
        for (int i = 0; i < n; ++i) {
            if (i == k || a(i, k).is_zero()) continue;
            const Ball f = one ? a(i, k) : a(i, k) * inverse;
            for (int j = k + 1; j < n; ++j)
                if (!a(k, j).is_zero()) a(i, j) -= f * a(k, j);
            for (int j = 0; j < b.cols; ++j)
                if (!b(k, j).is_zero()) b(i, j) -= f * b(k, j);
        }
    }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < b.cols; ++j) b(i, j) = b(i, j) / a(i, i);
    return b;
}

bool by_functionals(const PolynomialBasis& b) {
    return b.scheme() == Scheme::lagrange || b.scheme() == Scheme::hermite;
}

// L: what the coefficients in a Lagrange or Hermite basis of (t - o)^k are.
Table functionals(const PolynomialBasis& b, double o) {
    const int n = b.size();
    Table m(n, n);
    for (int i = 0; i < n; ++i) {
        const bool hermite = b.scheme() == Scheme::hermite;
        const Ball x = Ball(b.knot(hermite ? i % 2 : i)) - Ball(o);
        const int order = hermite ? i / 2 : 0;
        Ball power(1);
        for (int k = order; k < n; ++k) {  // k! / (k - order)! x^(k - order)
            Ball entry = power;
            for (int f = k; f > k - order; --f) entry *= Ball(f);
            m(i, k) = std::move(entry);
            power *= x;
        }
    }
    return m;
}

// V: the coefficients of the functions of the other bases in the powers of t - o.
Table functions(const PolynomialBasis& b, double o) {
    const int n = b.size();
    Table m(n, n);
    if (b.scheme() == Scheme::monomial || b.scheme() == Scheme::newton) {
        // Column by column, the next one is this one times t - x = (t - o) + (o - x). Monomials descend.
        const bool newton = b.scheme() == Scheme::newton;
        const auto column = [&](int j) { return newton ? j : n - 1 - j; };
        m(0, column(0)) = Ball(1);
        for (int j = 1; j < n; ++j) {
            const Ball shift = Ball(o) - Ball(b.knot(newton ? j - 1 : 0));
            for (int k = 0; k <= j; ++k) {
                Ball entry = shift * m(k, column(j - 1));
                if (k > 0) entry += m(k - 1, column(j - 1));
                m(k, column(j)) = std::move(entry);
            }
        }
        return m;
    }
    std::vector<Ball> w(std::size_t(n) + 1);
    Ball factorial(1);
    for (int k = 0; k < n; ++k) {
        if (k > 0) factorial *= Ball(k);
        weights_in_span(b, b.degree(), Ball(o), k, w.data());
        for (int j = 0; j < n; ++j) m(k, j) = w[std::size_t(j)] / factorial;
    }
    return m;
}

// The coefficients in `to` of the polynomials that have the columns of c as coefficients in `from`.
Table converted(const PolynomialBasis& from, const PolynomialBasis& to, Table c) {
    const double o = to.numbers()[to.scheme() == Scheme::bernstein || to.scheme() == Scheme::b_spline
                                      ? std::size_t(to.degree())
                                      : 0];
    if (from == to) return c;
    Table taylor =
        by_functionals(from) ? solution(functionals(from, o), std::move(c)) : product(functions(from, o), c);
    return by_functionals(to) ? product(functionals(to, o), taylor)
                              : solution(functions(to, o), std::move(taylor));
}

Result<std::vector<Bounded>> to_doubles(const Table& m, const PolynomialBasis& from,
                                        const PolynomialBasis& to) {
    std::vector<Bounded> out;
    for (const Ball& b : m.a) {
        const auto x = b.to_double();
        if (!x)
            return refuse(
                RefusalKind::ill_conditioned,
                text("[", out.size() / std::size_t(m.cols), "][", out.size() % std::size_t(m.cols), "]"),
                text("the change from ", name_of(from.scheme()), " to ", name_of(to.scheme()), " of degree ",
                     to.degree(), " leaves the range of double, or is not determined by 512 binary digits"));
        out.push_back(*x);
    }
    return out;
}

Result<void> check_degrees(const PolynomialBasis& from, const PolynomialBasis& to) {
    if (from.degree() != to.degree())
        return refuse(
            RefusalKind::invalid, "degree",
            text("from degree ", from.degree(), " to degree ", to.degree(), "; equal ones are expected"));
    return {};
}

// Not less than the largest sum of |value| + bound in a row.
double infinity_norm(const std::vector<Bounded>& a, int n) {
    double most = 0;
    for (int i = 0; i < n; ++i) {
        double sum = 0;
        for (int j = 0; j < n; ++j) {
            const Bounded& x = a[std::size_t(i * n + j)];
            sum += std::abs(x.value) + x.bound;
        }
        most = std::max(most, sum);
    }
    return most * (1 + 0x1p-40);
}

}  // namespace

BandMap BasisChange::map() const { return {size(), size(), std::vector<int>(std::size_t(size())), entry}; }

Result<BasisChange> change_basis(const PolynomialBasis& from, const PolynomialBasis& to) {
    if (auto ok = check_degrees(from, to); !ok) return std::unexpected(ok.error());
    const int n = from.size();
    const auto there = to_doubles(converted(from, to, identity(n)), from, to);
    if (!there) return std::unexpected(there.error());
    const auto back = to_doubles(converted(to, from, identity(n)), to, from);
    if (!back) return std::unexpected(back.error());
    BasisChange change{from, to, {}, {}};
    const double roundings = (n + 4) * kUnitRoundoff;
    for (int i = 0; i < n; ++i) {
        double sum = 0;
        for (int j = 0; j < n; ++j) {
            const Bounded& x = (*there)[std::size_t(i * n + j)];
            change.entry.push_back(x.value);
            change.error.push_back(x.bound);
            sum += x.bound + roundings * std::abs(x.value);
        }
        change.absolute_loss = std::max(change.absolute_loss, sum * (1 + 0x1p-40));
    }
    change.norm = infinity_norm(*there, n);
    change.inverse_norm = infinity_norm(*back, n);
    change.condition = change.norm * change.inverse_norm * (1 + 0x1p-40);
    change.relative_loss = change.absolute_loss * change.inverse_norm * (1 + 0x1p-40);
    if (!std::isfinite(change.condition) || !std::isfinite(change.relative_loss))
        return refuse(
            RefusalKind::ill_conditioned, "condition",
            text("the norms ", change.norm, " and ", change.inverse_norm, " have no finite product"));
    return change;
}

Result<ConvertedNumbers> convert_coefficients(const PolynomialBasis& from, const PolynomialBasis& to,
                                              std::span<const double> values, int columns) {
    return convert_coefficients(std::span(&from, 1), std::span(&to, 1), values, columns);
}

// After each change the axis goes to the end, behind the columns, so that the next one is in front.
Result<ConvertedNumbers> convert_coefficients(std::span<const PolynomialBasis> from,
                                              std::span<const PolynomialBasis> to,
                                              std::span<const double> values, int columns) {
    FF_REQUIRE(from.size() == to.size());
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < from.size(); ++axis) {
        if (auto ok = check_degrees(from[axis], to[axis]); !ok) return std::unexpected(ok.error());
        count *= std::size_t(from[axis].size());
    }
    if (columns < 0 || values.size() != count * std::size_t(columns))
        return refuse(
            RefusalKind::invalid, "coefficients",
            text(values.size(), " numbers for ", count, " coefficients of ", columns, " coordinates"));
    Table c(1, int(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i]))
            return refuse(RefusalKind::nonfinite, text("coefficients[", i / std::size_t(columns), "]"),
                          text(values[i], " is not a finite number"));
        c.a[i] = Ball(values[i]);
    }
    double condition = 1;
    for (std::size_t axis = 0; axis < from.size(); ++axis) {
        c.rows = from[axis].size();
        c.cols = int(c.a.size()) / c.rows;
        c = transposed(converted(from[axis], to[axis], std::move(c)));
        const auto change = change_basis(from[axis], to[axis]);
        if (!change) return std::unexpected(change.error());
        condition *= change->condition;
    }
    c.rows = columns;
    c.cols = int(count);
    auto out = to_doubles(transposed(c), from.back(), to.back());
    if (!out) return std::unexpected(out.error());
    return ConvertedNumbers{std::move(*out), condition};
}

}  // namespace freiform
