// Contacts of two plane curves in integers.
//
// Idea. Along A the implicit equation of B is a polynomial in one parameter, whose roots are isolated with
// their multiplicities (poly/roots_exact.cpp). The kernel of the matrix behind the equation gives the
// parameter on B as a quotient of polynomials, so that it is known, too, which of the roots are contacts.
//
// Notation. a_i = C(n, i) P_i, homogeneous coefficients of x^i, x = t / (1 - t). M is Bezout's matrix of B
// (query/implicit.cpp) with A(s) put in: its entries are polynomials of s, R(s) = det M. Where A(s) = B(t)
// and the point is no double point of B, the kernel of M is spanned by v = (1, x, x^2, ..), so its adjoint is
// a multiple of v v^T: x is the quotient of the first two cofactors of the first row, and, if t = 1, x =
// infinity, that of the last two of the last row.
//
// Method. A root s of R and a root t of the equation of A along B belong to each other if the quotient lies
// between numbers that separate t from its neighbours: two signs of polynomials at the algebraic number s.
// Such a sign is 0 if the polynomial and R have that root in common (their greatest common divisor says),
// otherwise that at an end of the interval, if no root of the polynomial lies in there.
//
// In space: of the contacts of the images without one coordinate, those at which this coordinate agrees: that
// is the sign of one more polynomial at s, in which v1 / v0 stands for the parameter of B.
//
// Multiplicity: that of s as a root of R is that of intersection of A at s with B, as long as B passes there
// only once; that is so where the cofactors do not vanish. Where they do, A and B change places.
//
// If R is zero everywhere, both curves run on the same algebraic curve: then ends decide (overlap.cpp).
//
// Accuracy. Exact: doubles are integers times a power of two.
//
// Cost. Two cubics: a millisecond. The search asks only where doubles leave something open.
//
// References: [Sederberg Anderson Goldman 1984], [Manocha Demmel 1994] for the kernel.
//
// Why not a resultant with respect to both parameters, and boxes? Two roots may be nearer to each other than
// doubles are, and then boxes do not say which belong together.
#include "exact_pair_detail.hpp"

#include <freiform/poly/determinant.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

using Whole = Form<Integer>;

bool vanishes(const Whole& f) {
    return std::all_of(f.s.begin(), f.s.end(), [](const Integer& x) { return x.sign() == 0; });
}

// Polynomials for determinants, which start from numbers.
struct Entry {
    Whole f;
    Entry() = default;
    explicit Entry(double x) : f{{integer(std::int64_t(x))}} {}
    explicit Entry(Whole w) : f(std::move(w)) {}
    friend Entry operator*(const Entry& a, const Entry& b) { return Entry(a.f * b.f); }
    friend Entry operator+(const Entry& a, const Entry& b) { return Entry(a.f + b.f); }
    friend Entry operator-(const Entry& a, const Entry& b) { return Entry(a.f - b.f); }
};

// a b_y' - .. of homogeneous points.
using Triple = std::array<Integer, 3>;
Triple line_through(const Triple& a, const Triple& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Triple coefficient(const ExactCurve& c, int i) {
    return {c.x[0].s[std::size_t(i)], c.x[1].s[std::size_t(i)], c.x[2].s[std::size_t(i)]};
}
// The line, or any such form, at the points of a curve.
Whole along(const ExactCurve& c, const Triple& line) {
    Whole sum{std::vector<Integer>(c.x[2].s.size())};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < sum.s.size(); ++i) sum.s[i] = sum.s[i] + line[k] * c.x[k].s[i];
    return sum;
}

std::vector<Entry> matrix_along(const ExactCurve& of, const ExactCurve& on) {
    const int n = of.degree();
    std::vector<Entry> m(std::size_t(n * n));
    for (int i = 0; i < n; ++i)
        for (int j = i; j < n; ++j) {
            Triple sum;
            for (int k = 0; k <= std::min(i, n - 1 - j); ++k) {
                const Triple l = line_through(coefficient(of, j + k + 1), coefficient(of, i - k));
                for (std::size_t c = 0; c < 3; ++c) sum[c] = sum[c] + l[c];
            }
            m[std::size_t(i * n + j)] = m[std::size_t(j * n + i)] = Entry(along(on, sum));
        }
    return m;
}

// The cofactor of entry (row, column).
Whole cofactor(const std::vector<Entry>& m, int n, int row, int column) {
    std::vector<Entry> minor;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (i != row && j != column) minor.push_back(m[std::size_t(i * n + j)]);
    Whole d = determinant<Entry>(minor, n - 1, n - 1).f;
    return (row + column) % 2 == 0 ? d : -1 * d;
}

// Bernstein coefficients up to a positive factor.
std::vector<Integer> bernstein_of(const Whole& f) {
    const int n = f.degree();
    std::vector<Integer> row(f.s.size(), integer(1));
    for (int i = 1; i <= n; ++i)
        row[std::size_t(i)] = divided(row[std::size_t(i) - 1] * integer(n - i + 1), integer(i)).quotient;
    Integer common = integer(1);
    for (const Integer& b : row) common = common * divided(b, gcd(common, b)).quotient;
    std::vector<Integer> c;
    for (std::size_t i = 0; i < f.s.size(); ++i) c.push_back(f.s[i] * divided(common, row[i]).quotient);
    return c;
}

// t = a / 2^k and 1 - t, times 2^k.
std::array<Integer, 2> dyadic(double t) {
    if (t == 0) return {Integer{}, integer(1)};
    Parts w = parts_of(t);
    while (w.m % 2 == 0) w.m /= 2, ++w.exponent;
    const int k = std::max(0, -w.exponent);
    const Integer a = shifted(w.m, w.exponent + k);
    return {a, shifted(1, k) - a};
}

int sign_at(const Whole& f, double t) {
    const auto [a, b] = dyadic(t);
    Integer sum, power = integer(1);
    for (std::size_t i = f.s.size(); i-- > 0;) {  // a^i b^(n-i)
        Integer term = f.s[i] * power;
        for (std::size_t k = 0; k < i; ++k) term = term * a;
        sum = sum + term;
        power = power * b;
    }
    return sum.sign();
}

// A polynomial and its isolated roots.
struct Zeros {
    const std::vector<Integer>& of;
    const std::vector<Root>& all;
};

// The sign of f at a root of another polynomial; nothing if that would take more than doubles to tell.
std::optional<int> sign_at(const Whole& f, const Root& root, const Zeros& zeros) {
    if (vanishes(f)) return 0;
    if (root.at.lo == root.at.hi) return sign_at(f, root.at.lo);
    const std::vector<Integer> c = bernstein_of(f);
    const auto near = [&](const Root& r) { return r.at.overlaps(root.at); };
    const std::vector<Root> roots = integer_roots(c, 0);
    if (std::none_of(roots.begin(), roots.end(), near)) return sign_at(f, root.at.lo);
    // A common root is one of R: this one, if its interval meets that of no other.
    for (const Root& r : common_roots(std::array{c, zeros.of}, 0))
        if (near(r) && std::count_if(zeros.all.begin(), zeros.all.end(),
                                     [&](const Root& o) { return o.at.overlaps(r.at); }) == 1)
            return 0;
    return std::nullopt;
}

// Does v1 / (v0 + v1) lie in `on` at a root? Nothing if it is not known.
std::optional<bool> lies_in(const std::array<Whole, 2>& v, const Interval& on, const Root& root,
                            const Zeros& zeros) {
    const Whole sum = v[0] + v[1];
    const auto whole = sign_at(sum, root, zeros);
    if (!whole || *whole == 0) return std::nullopt;
    const auto side = [&](double t) -> std::optional<int> {  // of v1 - t (v0 + v1)
        const auto [a, b] = dyadic(t);
        Whole g = sum;
        for (std::size_t i = 0; i < g.s.size(); ++i) g.s[i] = (a + b) * v[1].s[i] - a * g.s[i];
        const auto s = sign_at(g, root, zeros);
        if (!s) return std::nullopt;
        return *s * *whole;
    };
    const auto below = side(on.lo);
    if (!below) return std::nullopt;
    if (on.lo == on.hi) return *below == 0;
    if (*below < 0) return false;
    const auto above = side(on.hi);
    if (!above) return std::nullopt;
    return *above <= 0;
}

// A part of [0, 1] that has root i, and no other one; nothing if they are too near to each other.
std::optional<Interval> cell_of(const std::vector<Root>& roots, std::size_t i) {
    const auto between = [](double lo, double hi) {
        for (double n = 4; n < 0x1p52; n *= 2)
            if (const double x = std::floor(lo * n + 1) / n; x < hi) return x;
        return lo;
    };
    const Interval& at = roots[i].at;
    const double lo = i == 0 ? 0 : between(roots[i - 1].at.hi, at.lo);
    const double hi = i + 1 == roots.size() ? 1 : between(at.hi, roots[i + 1].at.lo);
    const bool apart = (i == 0 || lo > roots[i - 1].at.hi) && (i + 1 == roots.size() || hi > at.hi);
    if (!apart) return std::nullopt;
    return Interval{lo, hi};
}

// From `size` homogeneous coordinates, x and y and the weight last, maybe the third one before it.
ExactCurve exact_curve(std::span<const Integer> numbers, std::size_t size) {
    const int n = int(numbers.size() / size) - 1;
    std::vector<Whole> c(size);
    Integer binomial = integer(1);
    for (int i = 0; i <= n; ++i) {
        if (i > 0) binomial = divided(binomial * integer(n - i + 1), integer(i)).quotient;
        for (std::size_t k = 0; k < size; ++k)
            c[k].s.push_back(binomial * numbers[size * std::size_t(i) + k]);
    }
    // Elevated: all are multiples of 1 + x.
    for (bool again = true; again && c[0].degree() > 0;) {
        std::vector<Whole> lower(size);
        for (std::size_t k = 0; k < size; ++k) {
            Integer rest;
            for (int i = 0; i < c[k].degree(); ++i) {
                rest = c[k].s[std::size_t(i)] - rest;
                lower[k].s.push_back(rest);
            }
            again = again && rest == c[k].s.back();
        }
        if (again) c = std::move(lower);
    }
    return {{c[0], c[1], c[size - 1]}, size == 4 ? c[2] : Whole{}};
}

// sum f_i v1^i v0^(n - i): a coordinate of a curve at the parameter v1 / (v0 + v1).
Whole composed(const Whole& f, const std::array<Whole, 2>& v) {
    Whole sum;
    for (int i = 0; i <= f.degree(); ++i) {
        Whole term{{f.s[std::size_t(i)]}};
        for (int k = 0; k < f.degree(); ++k) term = term * v[std::size_t(k < i)];
        sum = sum + term;
    }
    return sum;
}

// All parameters of a curve at which it passes through a point.
std::vector<Root> parameters_of(const ExactCurve& c, const Triple& p) {
    std::vector<std::vector<Integer>> zero;
    for (std::size_t k = 0; k < 2; ++k) {
        Whole f = c.x[k];
        for (std::size_t i = 0; i < f.s.size(); ++i) f.s[i] = f.s[i] * p[2] - c.x[2].s[i] * p[k];
        if (!vanishes(f)) zero.push_back(bernstein_of(f));
    }
    if (zero.empty()) return {{{0, 1}, 1, 1, true, 0, 0}};  // it is the point
    return common_roots(zero, 0);
}

}  // namespace

bool ExactCurve::is_point() const { return degree() == 0; }

ExactPair::ExactPair(std::span<const Hom<2>> a, std::span<const Hom<2>> b) {
    std::vector<double> all;
    for (const auto& net : {a, b})
        for (const Hom<2>& p : net) all.insert(all.end(), p.c.begin(), p.c.end());
    const std::vector<Integer> numbers = integer_coefficients(all, 1);
    a_ = exact_curve(std::span(numbers).first(3 * a.size()), 3);
    b_ = exact_curve(std::span(numbers).subspan(3 * a.size()), 3);
}

ExactPair::ExactPair(std::span<const Hom<3>> a, std::span<const Hom<3>> b, int third) {
    std::vector<double> all;
    for (const auto& net : {a, b})
        for (const Hom<3>& p : net)
            for (const int k : {(third + 1) % 3, (third + 2) % 3, third, 3}) all.push_back(p[k]);
    const std::vector<Integer> numbers = integer_coefficients(all, 1);
    a_ = exact_curve(std::span(numbers).first(4 * a.size()), 4);
    b_ = exact_curve(std::span(numbers).subspan(4 * a.size()), 4);
}

bool ExactPair::is_bearable() const {
    return a_.degree() * b_.degree() <= kMaxProduct && std::max(a_.degree(), b_.degree()) <= kMaxDegree;
}

ExactPair::Side ExactPair::side(const ExactCurve& on, const ExactCurve& of) {
    Side s;
    const int n = of.degree();
    const std::vector<Entry> m = matrix_along(of, on);
    const Whole r = determinant<Entry>(m, n, n).f;
    if (vanishes(r)) return s;
    s.resultant = bernstein_of(r);
    s.roots = integer_roots(s.resultant, 0);
    if (n >= 2) {
        s.place[0] = {cofactor(m, n, 0, 0), cofactor(m, n, 0, 1)};
        s.place[1] = {cofactor(m, n, n - 1, n - 2), cofactor(m, n, n - 1, n - 1)};
        return s;
    }
    // A line through b_0, b_1: p = b_0 + x b_1, so p x b_1 and -p x b_0 are multiples 1 and x of b_0 x b_1.
    const Triple p = coefficient(of, 0), q = coefficient(of, 1), line = line_through(p, q);
    std::size_t k = 0;
    while (k < 2 && line[k].sign() == 0) ++k;
    const auto component = [&](const Triple& c, int sign) {  // of p(s) x c
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        Triple form;
        form[i] = integer(sign) * c[j];
        form[j] = integer(-sign) * c[i];
        return along(on, form);
    };
    s.place[0] = s.place[1] = {component(q, 1), component(p, -1)};
    return s;
}

void ExactPair::prepare() {
    if (!sides_) sides_ = {side(a_, b_), side(b_, a_)};
}

bool ExactPair::coincide() {
    if (a_.is_point() || b_.is_point()) return false;
    prepare();
    return (*sides_)[0].resultant.empty();
}

std::optional<bool> ExactPair::meets(const Side& side, const Root& root, const Interval& cell, bool high,
                                     const ExactCurve& on, const ExactCurve& of) {
    const auto& v = side.place[high];
    const Zeros zeros{side.resultant, side.roots};
    const auto in = lies_in(v, cell, root, zeros);
    if (!in || !*in || on.third.is_zero()) return in;
    const auto apart =
        sign_at(on.third * composed(of.x[2], v) - on.x[2] * composed(of.third, v), root, zeros);
    if (!apart) return std::nullopt;
    return *apart == 0;
}

std::optional<std::vector<ExactContact>> ExactPair::contacts(const Interval& a, const Interval& b) {
    std::vector<ExactContact> out;
    if (a_.is_point() || b_.is_point()) {
        if (!a_.third.is_zero()) return std::nullopt;
        for (const Interval& t : at_point(a_.is_point()))
            out.push_back(a_.is_point() ? ExactContact{{0, 1}, t, 0} : ExactContact{t, {0, 1}, 0});
        std::erase_if(out, [&](const ExactContact& c) { return !c.a.overlaps(a) || !c.b.overlaps(b); });
        return out;
    }
    if (coincide() || (*sides_)[1].resultant.empty()) return std::nullopt;
    const auto& [on_a, on_b] = *sides_;
    for (std::size_t i = 0; i < on_a.roots.size(); ++i) {
        const Root& s = on_a.roots[i];
        if (!s.at.overlaps(a)) continue;
        for (std::size_t k = 0; k < on_b.roots.size(); ++k) {
            const Root& t = on_b.roots[k];
            if (!t.at.overlaps(b)) continue;
            const auto cell_s = cell_of(on_a.roots, i), cell_t = cell_of(on_b.roots, k);
            if (!cell_s || !cell_t) return std::nullopt;
            if (!s.is_one || !t.is_one) return std::nullopt;
            // One of the curves may have a cusp or double point there.
            int multiplicity = s.most;
            auto in = meets(on_a, s, *cell_t, t.at.middle() > 0.5, a_, b_);
            if (!in) {
                multiplicity = t.most;
                in = meets(on_b, t, *cell_s, s.at.middle() > 0.5, b_, a_);
            }
            if (!in) return std::nullopt;
            if (*in) out.push_back({s.at, t.at, multiplicity});
        }
    }
    return out;
}

std::optional<std::vector<ExactContact>> ExactPair::ends() const {
    if (a_.is_point() || b_.is_point()) return std::nullopt;
    std::vector<ExactContact> out;
    const auto add = [&](const ExactContact& c) {
        for (const ExactContact& o : out)
            if (o.a == c.a && o.b == c.b) return;
        out.push_back(c);
    };
    for (const int end : {0, 1}) {
        const double t = end;
        for (const Root& r : parameters_of(b_, coefficient(a_, end * a_.degree()))) add({{t, t}, r.at, 0});
        for (const Root& r : parameters_of(a_, coefficient(b_, end * b_.degree()))) add({r.at, {t, t}, 0});
    }
    return out;
}

std::vector<Interval> ExactPair::at_point(bool first) const {
    std::vector<Interval> out;
    for (const Root& r : parameters_of(first ? b_ : a_, coefficient(first ? a_ : b_, 0))) out.push_back(r.at);
    return out;
}

}  // namespace freiform::detail
