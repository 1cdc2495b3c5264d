// Implicit equations by Bezout's determinant.
//
// Idea: (x, y) is on the curve (X, Y, W)(t) if f = x W - X and g = y W - Y have a common root t. The
// Bezoutian (f(s) g(t) - f(t) g(s)) / (s - t) is a symmetric bilinear form in the monomials of s and t, whose
// determinant is the resultant of f and g. Its entries are linear in x and y: the terms with x y cancel.
//
// Notation: n the degree; a_i = C(n, i) P_i, the homogeneous coefficients of t^i (1 - t)^(n - i); l_ij = a_i
// x a_j the line through two of them; F = det M.
//
// Method: M_ij = sum of l_{j+k+1, i-k} over k = 0 .. min(i, n - 1 - j), for i <= j. These are integer
// combinations of products of coordinates, so that the same loop serves doubles with bounds, polynomials, and
// exact numbers.
//
// If X, Y, W have a common factor of degree r (an elevated curve), f and g have it for all x, y, and det M =
// 0. With f = d f1, g = d g1, M = D^T M1 D, where D has n - r rows and column i holds the coefficients of d
// from entry i on; its leading square block is triangular with d(0) on the diagonal. Weights are positive, so
// d(0) is not 0, and the leading minor of order n - r is d(0)^(2 (n - r)) det M1. So the degree of F is the
// order of the largest leading minor that does not vanish identically, and that minor is F. A minor of order
// m is a polynomial of degree m, which vanishes if it does on a triangular grid of (m + 1)(m + 2) / 2 points;
// this is decided exactly.
//
// At a point of the curve the rank of M is degree - (number of parameters that lead there). The least such
// number over more parameters than double points of a curve of this degree can have is the number of traces.
//
// Accuracy: Bounded arithmetic throughout, after multiplying x, y and w by powers of two that make the
// largest coefficient of each about 1; what underflows in that is added to the bound. If the bound does not
// tell the sign, the determinant is computed in exact arithmetic from the unscaled doubles.
//
// Cost: n 2^(n-1) products for F: 0.3 us for a cubic, 15 us at degree 8; the exact sign 1 ms there.
//
// References: [Sederberg Anderson Goldman 1984], [Goldman Sederberg Anderson 1984] for the vanishing of the
// determinant, [Bini Gemignani 2004] for Bezoutians in Bernstein form.
//
// Why not the resultant of Sylvester? Twice the order, and not symmetric. Why not coefficients alone? Powers
// of x and y cancel away from the origin.
#include <freiform/poly/determinant.hpp>
#include <freiform/poly/exact.hpp>
#include <freiform/query/implicit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// Calls entry(i, j, p, q) for every line a_p x a_q that is a summand of M_ij, i <= j.
template <class F>
void each_summand(int n, F&& entry) {
    for (int i = 0; i < n; ++i)
        for (int j = i; j < n; ++j)
            for (int k = 0; k <= std::min(i, n - 1 - j); ++k) entry(i, j, j + k + 1, i - k);
}

// Exact homogeneous coordinates of scaled Bernstein coefficients or points.
using ExactHom = std::array<Exact, 3>;

std::vector<ExactHom> exact_coefficients(std::span<const Hom<2>> net) {
    const int n = int(net.size()) - 1;
    std::vector<ExactHom> a;
    for (int i = 0; i <= n; ++i) {
        ExactHom h;
        for (int k = 0; k < 3; ++k) h[std::size_t(k)] = Exact(binomial(n, i)) * Exact(net[std::size_t(i)][k]);
        a.push_back(h);
    }
    return a;
}

// M at a point in homogeneous coordinates.
std::vector<Exact> exact_matrix(const std::vector<ExactHom>& a, const ExactHom& p) {
    const int n = int(a.size()) - 1;
    std::vector<Exact> m(std::size_t(n * n));
    each_summand(n, [&](int i, int j, int s, int t) {
        const ExactHom &u = a[std::size_t(s)], &v = a[std::size_t(t)];
        m[std::size_t(i * n + j)] = m[std::size_t(i * n + j)] + p[0] * (u[1] * v[2] - u[2] * v[1]) +
                                    p[1] * (u[2] * v[0] - u[0] * v[2]) + p[2] * (u[0] * v[1] - u[1] * v[0]);
    });
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j) m[std::size_t(i * n + j)] = m[std::size_t(j * n + i)];
    return m;
}

int exact_minor_sign(const std::vector<ExactHom>& a, int order, const ExactHom& p) {
    return determinant<Exact>(exact_matrix(a, p), order, int(a.size()) - 1).sign();
}

// The order of the largest leading minor that is not identically 0.
int generic_rank(const std::vector<ExactHom>& a) {
    for (int m = int(a.size()) - 1; m > 0; --m)
        // Small whole numbers near a control point in homogeneous coordinates would do, too; any grid does.
        for (int i = m; i >= 0; --i)
            for (int j = m - i; j >= 0; --j)
                if (exact_minor_sign(a, m, {Exact(i), Exact(j), Exact(1)}) != 0) return m;
    return 0;
}

// sum a_i t^i (1 - t)^(n - i) at t = s / 64, times 64^n.
ExactHom exact_point(const std::vector<ExactHom>& a, int s) {
    const int n = int(a.size()) - 1;
    ExactHom p;
    for (int i = 0; i <= n; ++i) {
        Exact b(1);
        for (int k = 0; k < n; ++k) b = b * Exact(k < i ? s : 64 - s);
        for (std::size_t k = 0; k < 3; ++k) p[k] = p[k] + b * a[std::size_t(i)][k];
    }
    return p;
}

// The least number of parameters, counted with multiplicity, that lead to a point, over many points.
int trace_count(const std::vector<ExactHom>& a, int degree) {
    int traces = degree;
    for (int s = 1; s <= (degree - 1) * (degree - 2) + 1 && traces > 1; ++s) {
        const std::vector<Exact> m = exact_matrix(a, exact_point(a, s));
        int rank = degree;
        while (rank > degree - traces && rank > 0 &&
               determinant<Exact>(m, rank, int(a.size()) - 1).sign() == 0)
            --rank;
        traces = std::min(traces, degree - rank);
    }
    return std::max(traces, 1);
}

// Polynomials in x and y of degree <= kMaxImplicitDegree: coefficient (i, j) at i (n + 1) + j.
struct PlanePolynomial {
    static constexpr int kSide = kMaxImplicitDegree + 1;
    int degree = -1;  // of zero
    std::vector<Bounded> c;

    PlanePolynomial() = default;
    explicit PlanePolynomial(double constant) : degree(0), c(std::size_t(kSide * kSide)) { c[0] = constant; }
    Bounded& at(int i, int j) { return c[std::size_t(i * kSide + j)]; }
    const Bounded& at(int i, int j) const { return c[std::size_t(i * kSide + j)]; }

    static PlanePolynomial combined(const PlanePolynomial& a, const PlanePolynomial& b, bool minus) {
        PlanePolynomial s;
        s.degree = std::max(a.degree, b.degree);
        s.c.resize(std::size_t(kSide * kSide));
        for (int i = 0; i <= s.degree; ++i)
            for (int j = 0; i + j <= s.degree; ++j) {
                const Bounded x = i + j <= a.degree ? a.at(i, j) : Bounded();
                const Bounded y = i + j <= b.degree ? b.at(i, j) : Bounded();
                s.at(i, j) = minus ? x - y : x + y;
            }
        return s;
    }
    friend PlanePolynomial operator+(const PlanePolynomial& a, const PlanePolynomial& b) {
        return combined(a, b, false);
    }
    friend PlanePolynomial operator-(const PlanePolynomial& a, const PlanePolynomial& b) {
        return combined(a, b, true);
    }
    friend PlanePolynomial operator*(const PlanePolynomial& a, const PlanePolynomial& b) {
        PlanePolynomial p;
        if (a.degree < 0 || b.degree < 0) return p;
        p.degree = a.degree + b.degree;
        p.c.resize(std::size_t(kSide * kSide));
        for (int i = 0; i <= a.degree; ++i)
            for (int j = 0; i + j <= a.degree; ++j)
                for (int k = 0; k <= b.degree; ++k)
                    for (int l = 0; k + l <= b.degree; ++l)
                        p.at(i + k, j + l) = p.at(i + k, j + l) + a.at(i, j) * b.at(k, l);
        return p;
    }
};

// x 2^-e, with what underflows as the bound.
Bounded scaled(double x, int e) {
    const double y = std::scalbn(x, -e);
    return {y, std::abs(y) < 0x1p-1022 && x != 0 ? 0x1p-1074 : 0};
}

}  // namespace

Result<Implicit> Implicit::make(const Curve<Vec<2>, Bernstein>& curve) { return make(to_rational(curve)); }

Result<Implicit> Implicit::make(const Curve<Hom<2>, Bernstein>& curve) {
    Implicit f;
    f.curve_.assign(curve.net().flat().begin(), curve.net().flat().end());
    const int n = f.order();
    if (n < 1) return refuse(RefusalKind::no_answer, "curve", "has degree 0: it is a point");
    if (n > kMaxImplicitDegree)
        return refuse(RefusalKind::unsupported, "curve",
                      text("has degree ", n, "; implicit forms go up to ", kMaxImplicitDegree));
    for (int k = 0; k < 3; ++k) {
        double most = 0;
        for (const Hom<2>& h : f.curve_) most = std::max(most, std::abs(h[k]));
        f.exponent_[std::size_t(k)] = most == 0 ? 0 : std::ilogb(most);
    }
    const auto exact = exact_coefficients(f.curve_);
    f.degree_ = generic_rank(exact);
    if (f.degree_ == 0) return refuse(RefusalKind::no_answer, "curve", "is a single point");
    f.traces_ = trace_count(exact, f.degree_);

    std::vector<std::array<Bounded, 3>> a;
    for (int i = 0; i <= n; ++i) {
        a.emplace_back();
        for (int k = 0; k < 3; ++k)
            a.back()[std::size_t(k)] =
                Bounded(binomial(n, i)) * scaled(f.curve_[std::size_t(i)][k], f.exponent_[std::size_t(k)]);
    }
    f.matrix_.resize(std::size_t(n * n));
    each_summand(n, [&](int i, int j, int s, int t) {
        const auto &u = a[std::size_t(s)], &v = a[std::size_t(t)];
        const std::array line{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                              u[0] * v[1] - u[1] * v[0]};
        for (std::size_t k = 0; k < 3; ++k) {
            Bounded& sum = f.matrix_[std::size_t(i * n + j)][k];
            sum = sum + line[k];
            f.matrix_[std::size_t(j * n + i)][k] = sum;
        }
    });
    return f;
}

std::array<Bounded, 3> Implicit::entry(int i, int j) const {
    FF_REQUIRE(i >= 0 && j >= 0 && i < degree_ && j < degree_);
    return matrix_[std::size_t(i * order() + j)];
}

Vec<2> Implicit::scale() const {
    return {{std::scalbn(1.0, exponent_[0] - exponent_[2]), std::scalbn(1.0, exponent_[1] - exponent_[2])}};
}

Bounded Implicit::operator()(const Vec<2>& at) const {
    const Bounded x = scaled(at[0], exponent_[0] - exponent_[2]),
                  y = scaled(at[1], exponent_[1] - exponent_[2]);
    std::vector<Bounded> m;
    for (int i = 0; i < degree_; ++i)
        for (int j = 0; j < degree_; ++j) {
            const auto e = entry(i, j);
            m.push_back(e[0] * x + e[1] * y + e[2]);
        }
    return determinant<Bounded>(m, degree_, degree_);
}

int Implicit::sign(const Vec<2>& at) const {
    FF_REQUIRE(is_finite(at));
    const Bounded f = (*this)(at);
    if (f.is_zero()) return 0;
    if (f.excludes_zero() && f.is_finite()) return f.value > 0 ? 1 : -1;
    return exact_minor_sign(exact_coefficients(curve_), degree_, {Exact(at[0]), Exact(at[1]), Exact(1)});
}

Result<std::vector<Implicit::Term>> Implicit::terms() const {
    std::vector<PlanePolynomial> m;
    for (int i = 0; i < degree_; ++i)
        for (int j = 0; j < degree_; ++j) {
            const auto e = entry(i, j);
            PlanePolynomial line(0);
            line.degree = 1;
            line.at(1, 0) = e[0], line.at(0, 1) = e[1], line.at(0, 0) = e[2];
            m.push_back(std::move(line));
        }
    const PlanePolynomial f = determinant<PlanePolynomial>(m, degree_, degree_);
    // Back to the given coordinates: x^i y^j times 2^-(i ex + j ey), all divided by a common power of two.
    const int ex = exponent_[0] - exponent_[2], ey = exponent_[1] - exponent_[2];
    int top = std::numeric_limits<int>::min();
    for (int i = 0; i <= degree_; ++i)
        for (int j = 0; i + j <= degree_; ++j)
            if (const double v = f.at(i, j).value; v != 0)
                top = std::max(top, std::ilogb(v) - i * ex - j * ey);
    std::vector<Term> terms;
    for (int total = 0; total <= degree_; ++total)
        for (int j = 0; j <= total; ++j) {
            const int i = total - j, shift = -i * ex - j * ey - top;
            const Bounded& c = f.at(i, j);
            const double value = std::scalbn(c.value, shift), bound = std::scalbn(c.bound, shift);
            if (!std::isfinite(bound) || (c.value != 0 && std::abs(value) < 0x1p-1022))
                return refuse(
                    RefusalKind::ill_conditioned, "curve",
                    "the coefficients of its equation are too far apart for doubles; the matrix form is not");
            terms.push_back({i, j, {value, bound + (c.bound != 0 ? 0x1p-1074 : 0)}});
        }
    return terms;
}

}  // namespace freiform
