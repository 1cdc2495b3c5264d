// All real roots of a polynomial in Bernstein form.
//
// Idea. Descartes' rule: a polynomial has at most as many roots in (0, 1) as its Bernstein coefficients have
// sign variations, and differs from that by an even number [Lane Riesenfeld 1981]. Zero variations: none;
// one: exactly one. Otherwise halve by de Casteljau's algorithm and ask again. That needs only signs of
// coefficients, so rounding matters only where a coefficient is smaller than a bound of its error.
//
// Notation. u = 2^-53 for double, 2^-100 for double-double. A piece is a part [j, j + 1] / 2^k of [0, 1] with
// coefficients b_i, each off by at most E; M = max |b_i|. A sign is certain if |b_i| > E.
//
// Method. 1. Coefficients are scaled by a power of two so that 1/2 <= M < 1. Zeros at the ends are roots
// there.
// 2. Depth first, from left to right, in doubles: all signs certain and equal: no root. Signs at both ends
// certain and different, and no choice of the uncertain ones gives more than one variation: one root. A piece
// with M <= 8 E or of depth 52 is undecided. Others are halved.
// 3. Undecided pieces of exact polynomials are cut out of the polynomial and searched in double-double. What
// is still undecided is searched in integers (roots_exact.cpp), which decide everything. Of polynomials that
// are known up to an error, neighbouring undecided pieces are one answer: the signs on both sides say whether
// a root is certain.
// 4. A bracket of a simple root is narrowed by Newton's method with bisection; where the sign of a double
// value is not certain, integers give it.
//
// Accuracy. Halving takes means (a + b) / 2: the division is exact, so each mean is off by u M plus the error
// of its terms: n rows add at most 1.01 n u M to E. Cutting out [a, b] in double-double takes 2 n rows of
// (1 - x) a + x b, with x off by 2u relatively: 8 u M each. A value by de Casteljau carries 3 roundings per
// row: 3.1 n u M + E. Operations of double-double have relative errors below 2^-100 (double_double.hpp).
// Underflow: scaled coefficients are below 1, doubles lose at most 2^-1074 in each operation, double-doubles
// 2^-860; E starts at 2^-840, more than all of that together for n <= 100 and depth 52. (So coefficients that
// are smaller have no certain sign, and go to the last stage.)
//   The number of roots of all polynomials within E in a closed piece is at most the largest number of
// variations that any choice of the uncertain signs gives: a choice of coefficients for which a first or last
// one is zero has a root at that end for each, and giving those zeros alternating signs adds one variation
// for each.
//
// Cost. n^2 / 2 means per halving, and about log2(1 / distance) halvings for two roots near to each other.
//
// References. [Lane Riesenfeld 1981], [Rouillier Zimmermann 2004] (halving and termination). With rounding
// bounded in the same way: [Mehlhorn Sagraloff 2011].
//
// Why not Bezier clipping [SederbergNishita1990]? It converges faster to one root, but Newton's method does
// that here, and clipped ends are no dyadic numbers, for which later stages could repeat the cut exactly. Why
// not eigenvalues of a companion matrix? They say neither how many roots are real nor that none was missed.
#include "poly/roots_search_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace detail {

namespace {

Interval interval_of(const Cell& c) {
    return {std::scalbn(double(c.cell), -c.depth), std::scalbn(double(c.cell + 1), -c.depth)};
}

// --- the polynomial ----------------------------------------------------------------------------------------

// All that is known about the polynomial p / (t^at_zero (1 - t)^at_one), scaled.
struct Problem {
    std::vector<double> c;          // rounded
    double error = kUnderflow;      // of c
    std::span<const double> parts;  // of p, exact; empty: its coefficients are not known exactly
    int terms = 1, exponent = 0;    // c is p multiplied by 2^-exponent
    int at_zero = 0, at_one = 0;    // multiplicities of exact roots at the ends
    int degree() const { return int(c.size()) - 1; }
};

// Cut out of the whole, in double-double.
std::vector<DoubleDouble> cut(const Problem& p, const Cell& cell, double& error) {
    const int n = p.degree();
    std::vector<DoubleDouble> b(p.c.size());
    double size = 0;
    for (std::size_t i = 0; i < p.c.size(); ++i) {
        double sum = 0;
        for (int k = 0; k < p.terms; ++k) {
            const double x = std::scalbn(p.parts[i * std::size_t(p.terms) + std::size_t(k)], -p.exponent);
            b[i] = b[i] + DoubleDouble(x);
            sum += std::abs(x);
        }
        size = std::max(size, sum);
    }
    const double u = kUnit<DoubleDouble>;
    error = kUnderflow + (p.terms > 1 ? 1.01 * p.terms * u * size : 0);
    const Interval on = interval_of(cell);
    const auto row = [&](int r, DoubleDouble x, DoubleDouble y, bool keep_right) {
        if (keep_right)
            for (int i = 0; i + r <= n; ++i)
                b[std::size_t(i)] = x * b[std::size_t(i)] + y * b[std::size_t(i) + 1];
        else
            for (int i = n; i >= r; --i)
                b[std::size_t(i)] = x * b[std::size_t(i) - 1] + y * b[std::size_t(i)];
    };
    if (on.lo > 0) {
        for (int r = 1; r <= n; ++r) row(r, DoubleDouble(1) - on.lo, on.lo, true);
        error += 8.1 * n * u * size;
    }
    if (on.hi < 1) {
        const DoubleDouble x = DoubleDouble(on.hi - on.lo) / (DoubleDouble(1) - on.lo);
        const DoubleDouble y = DoubleDouble(1) - x;
        for (int r = 1; r <= n; ++r) row(r, y, x, false);
        error += 8.1 * n * u * size;
    }
    return b;
}

struct Value {
    double value, slope;
};
Value value_at(std::span<const double> c, double t) {
    constexpr std::size_t kMost = std::size_t(kMaxRootDegree) + 1;
    double b[kMost];
    const std::size_t n = c.size() - 1;
    std::copy(c.begin(), c.end(), b);
    const double s = 1 - t;
    for (std::size_t r = 1; r < n; ++r)
        for (std::size_t i = 0; i + r <= n; ++i) b[i] = s * b[i] + t * b[i + 1];
    return {s * b[0] + t * b[1], double(n) * (b[1] - b[0])};
}

class Solver {
public:
    Solver(Problem problem, double width) : p_(std::move(problem)), width_(width) {}

    RealRoots solve() {
        RealRoots out;
        if (p_.at_zero > 0) out.roots.push_back({{0, 0}, p_.at_zero, p_.at_zero, true, 0, 0});
        std::vector<Found> found;
        RootSearch<double>(p_.c.data(), p_.degree(), p_.error, {}).run(found);
        if (p_.parts.empty()) {
            report_uncertain(found, out.roots);
            return out;
        }
        const std::vector<Cell> undecided = settle(found, out.deepest);
        for (const Found& f : found) add(out.roots, f, true);
        if (!undecided.empty()) {
            out.deepest = Arithmetic::exact;
            const auto more = exact_roots(integers().coefficients(), undecided, width_);
            out.roots.insert(out.roots.end(), more.begin(), more.end());
            sort(out.roots.begin(), out.roots.end(), [](const Root& a, const Root& b) {
                return a.at.lo < b.at.lo || (a.at.lo == b.at.lo && a.at.hi < b.at.hi);
            });
        }
        if (p_.at_one > 0) out.roots.push_back({{1, 1}, p_.at_one, p_.at_one, true, 0, 0});
        if (!out.roots.empty()) set_signs(out.roots, first_sign());
        return out;
    }

private:
    // Searches undecided pieces in double-double; what stays undecided is a cell for integers. Only decided
    // pieces are left in `found`.
    std::vector<Cell> settle(std::vector<Found>& found, Arithmetic& deepest) {
        std::vector<Found> all;
        for (const Found& f : found) {
            if (f.decided || p_.at_zero + p_.at_one > 0) {
                all.push_back(f);
                continue;
            }
            deepest = Arithmetic::doubled;
            double error = 0;
            const auto b = cut(p_, f.cell, error);
            RootSearch<DoubleDouble>(b.data(), p_.degree(), error, f.cell).run(all);
        }
        found.clear();
        std::vector<Cell> undecided;
        for (const Found& f : all)
            if (f.decided)
                found.push_back(f);
            else
                undecided.push_back(f.cell);
        return undecided;
    }

    void add(std::vector<Root>& roots, const Found& f, bool ask_integers) {
        ExactSign* exact = nullptr;
        Interval at = refined({p_.c, p_.error}, exact, interval_of(f.cell), f.before, width_);
        if (ask_integers && at.length() > width_)
            at = refined({p_.c, p_.error}, &integers(), at, f.before, width_);
        roots.push_back({at, 1, 1, true, f.before, f.after});
    }

    // Coefficients up to `error`: undecided neighbours are one answer.
    void report_uncertain(const std::vector<Found>& found, std::vector<Root>& roots) {
        for (std::size_t i = 0; i < found.size();) {
            if (found[i].decided) {
                add(roots, found[i++], false);
                continue;
            }
            Root r{interval_of(found[i].cell), 0, 0, false, 0, 0};
            for (; i < found.size() && !found[i].decided && interval_of(found[i].cell).lo <= r.at.hi; ++i) {
                r.at.hi = interval_of(found[i].cell).hi;
                r.most = std::min(r.most + found[i].most, p_.degree());
            }
            const int before = certain_sign(r.at.lo), after = certain_sign(r.at.hi);
            r.least = before * after < 0;
            r.most = std::max(r.most, r.least);
            r.before = r.at.lo == 0 ? 0 : before;
            r.after = r.at.hi == 1 ? 0 : after;
            if (r.most > 0) roots.push_back(r);
        }
    }
    int certain_sign(double t) const {
        const double v = value_at(p_.c, t).value, error = p_.error + 3.1 * p_.degree() * kUnitRoundoff;
        return v > error ? 1 : v < -error ? -1 : 0;
    }

    // The sign right of 0. The first coefficient is not zero.
    int first_sign() {
        if (std::abs(p_.c[0]) > p_.error) return p_.c[0] > 0 ? 1 : -1;
        return integers().coefficients()[std::size_t(p_.at_zero)].sign();
    }
    ExactSign& integers() {
        if (!integers_) integers_.emplace(integer_coefficients(p_.parts, p_.terms));
        return *integers_;
    }

    Problem p_;
    double width_;
    std::optional<ExactSign> integers_;
};

}  // namespace

void set_signs(std::vector<Root>& roots, int sign) {
    for (Root& r : roots) {
        r.before = r.at.hi == 0 ? 0 : sign;
        if (r.most % 2 != 0 && r.before != 0) sign = -sign;
        r.after = r.at.lo == 1 ? 0 : sign;
    }
}

Interval refined(const Approximate& p, const ExactSign* exact, Interval at, int before, double width) {
    const double n = double(p.c.size()) - 1;
    if (p.c.size() < 2) return at;
    const double error = p.error + 3.1 * n * kUnitRoundoff;
    // Moves an end to x if the sign there is known; says whether it is.
    const auto put = [&](double x, double value, bool ask) {
        int s = value > error ? 1 : value < -error ? -1 : 0;
        if (s == 0 && ask && exact != nullptr) {
            s = (*exact)(x);
            if (s == 0) {
                at = {x, x};
                return true;
            }
        }
        if (s == before) at.lo = x;
        if (s == -before) at.hi = x;
        return s != 0;
    };
    double x = at.middle(), last = at.length();
    bool ask = false;  // integers, if need be
    for (int step = 0; step < 2200 && at.hi - at.lo > width; ++step) {
        if (!(at.lo < x && x < at.hi)) x = at.middle();
        if (!(at.lo < x && x < at.hi)) break;  // neighbouring doubles
        const Value v = value_at(p.c, x);
        const bool known = put(x, v.value, ask);
        if (!(at.lo < at.hi)) break;
        const double next = x - v.value / v.slope, move = std::abs(next - x);
        const bool near = !known || move <= 0.25 * width;
        if (!near) {  // Newton's step, if it is less than half as long as the last one
            const bool good = at.lo < next && next < at.hi && 2 * move <= last;
            last = good ? move : at.length();
            x = good ? next : at.middle();
            continue;
        }
        // Enclose the root; without integers, as narrowly as signs are certain.
        const double centre = at.lo < next && next < at.hi ? next : x;
        for (const double side : {-1.0, 1.0}) {
            double reach = std::max(0.45 * width, 0x1p-53 * centre);
            for (int k = 0; k < 1100; ++k, reach *= 2) {
                const double y = centre + side * reach;
                if (!(at.lo < y && y < at.hi) || put(y, value_at(p.c, y).value, false)) break;
            }
        }
        if (exact == nullptr) break;
        ask = true;
        x = at.middle();
        last = at.length();
    }
    return at;
}

namespace {

// Exact roots at the ends divided out: c_i C(n, i) / C(n - m, i - at_zero), the quotient as a product.
void divide_ends(Problem& p) {
    const int n = p.degree(), m = p.at_zero + p.at_one;
    std::vector<double> c(std::size_t(n - m) + 1);
    // The factor of i = at_zero is C(n, at_zero) / C(n - m, 0), each further one is
    // (n - i + 1) / i * (i - at_zero) / (n - at_one - i + 1) times the one before.
    double factor = 1, most = 0;
    for (int i = p.at_zero; i <= n - p.at_one; ++i) {
        if (i > p.at_zero)
            factor *= double(n - i + 1) * (i - p.at_zero) / (double(i) * (n - p.at_one - i + 1));
        const std::size_t k = std::size_t(i - p.at_zero);
        c[k] = p.c[std::size_t(i)] * factor;
        most = std::max(most, factor);
    }
    // A factor carries 2 n roundings (the products of integers are exact), a coefficient one more; the
    // coefficients that were divided out are below 1.
    p.error = (p.error + (2 * n + 2) * 1.01 * kUnitRoundoff) * most;
    const int e = std::max(0, std::ilogb(most) + 1);
    for (double& x : c) x = std::scalbn(x, -e);
    p.error = std::scalbn(p.error, -e) + kUnderflow;
    p.c = std::move(c);
}

// Nothing if the polynomial is zero, or is zero within its error.
std::optional<Problem> scaled(std::span<const double> parts, int terms, double error, double most) {
    const std::size_t count = parts.size() / std::size_t(terms);
    Problem p;
    p.terms = terms;
    p.exponent = std::ilogb(most) + 1 + (terms > 1 ? std::ilogb(terms) + 1 : 0);
    p.c.resize(count);
    if (error == 0) p.parts = parts;
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double sum = 0;
        for (const double x : parts.subspan(i * std::size_t(terms), std::size_t(terms)))
            sum += std::scalbn(x, -p.exponent);
        p.c[i] = sum;
        largest = std::max(largest, std::abs(sum));
    }
    p.error += std::scalbn(error, -p.exponent) + (terms > 1 ? terms * kUnitRoundoff : 0);
    if (error > 0) return largest <= p.error ? std::nullopt : std::optional(std::move(p));
    const auto is_zero = [&](std::size_t i) {
        if (std::abs(p.c[i]) > p.error) return false;
        const auto own = parts.subspan(i * std::size_t(terms), std::size_t(terms));
        if (terms == 1) return own[0] == 0;
        return integer_coefficients(own, terms)[0].sign() == 0;
    };
    while (std::size_t(p.at_zero) < count && is_zero(std::size_t(p.at_zero))) ++p.at_zero;
    if (std::size_t(p.at_zero) == count) return std::nullopt;
    while (is_zero(count - 1 - std::size_t(p.at_one))) ++p.at_one;
    if (p.at_zero + p.at_one > 0) divide_ends(p);
    return p;
}

}  // namespace

}  // namespace detail

namespace {

Result<RealRoots> solved(std::span<const double> parts, int terms, double width, double error) {
    const std::size_t count = parts.size() / std::size_t(terms);
    if (count > std::size_t(kMaxRootDegree) + 1)
        return refuse(RefusalKind::unsupported, "coefficients",
                      text("degree ", count - 1, " is outside 0..", kMaxRootDegree));
    if (!(width >= 0) || !(error >= 0) || !std::isfinite(error))
        return refuse(RefusalKind::invalid, width >= 0 ? "error" : "width",
                      text(width >= 0 ? error : width, " is not a finite number >= 0"));
    double most = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!std::isfinite(parts[i]))
            return refuse(RefusalKind::nonfinite, text("coefficients[", i / std::size_t(terms), "]"),
                          text(parts[i], " is not a finite number"));
        most = std::max(most, std::abs(parts[i]));
    }
    RealRoots out;
    out.kind = error == 0 ? RootsKind::zero : RootsKind::possibly_zero;
    if (most <= error) return out;
    auto problem = detail::scaled(parts, terms, error, most);
    if (!problem) return out;
    return detail::Solver(std::move(*problem), width).solve();
}

}  // namespace

Result<RealRoots> real_roots(std::span<const double> coefficients, double width, double error) {
    if (coefficients.empty()) return refuse(RefusalKind::invalid, "coefficients", "there are none");
    return solved(coefficients, 1, width, error);
}

Result<RealRoots> real_roots_of_sums(std::span<const double> parts, int terms, double width) {
    if (terms < 1 || parts.empty() || parts.size() % std::size_t(terms) != 0)
        return refuse(RefusalKind::invalid, "coefficients",
                      text(parts.size(), " parts are not ", terms, " for each of one coefficient or more"));
    return solved(parts, terms, width, 0);
}

}  // namespace freiform
