// Idea. With the point as origin, the arc is (h, g) / w, and what is counted are the jumps of h / g from one
// infinity to the other: the Cauchy index of h / g, which for a closed curve is twice its winding number.
// Where h has one sign along a piece the index is that of the signs of g at its ends; where g has one sign it
// is 0. So pieces are halved until one of the two has a certain sign. A piece that stays undecided contains
// the point, or comes closer to it than rounding shows; then the whole arc is decided with integers, by
// Sturm's theorem.
//
// Notation. g_i = y_i - q_y w_i, h_i = x_i - q_x w_i: Bernstein coefficients. x = t / (1 - t): the power form
// in x has the coefficients C(n, i) g_i, and t in (0, 1) is x in (0, infinity).
//
// Method. Sturm: S_0 = g, S_1 = h, S_{k+1} = -rem(S_{k-1}, S_k) up to positive factors; the index over an
// open interval is V(lower end) - V(upper end), V the number of sign variations of the chain just inside.
// Just above x = 0 a polynomial has the sign of its lowest coefficient, far out that of its highest. The ends
// of the arc are added by hand: half a crossing each where g = 0 there. The last S is the greatest common
// divisor of g and h, whose roots are where the arc meets the point.
//
// Accuracy. Halving: an average of two numbers is off by 2^-53 of the larger; n averages deep, the error of a
// coefficient grows by n 2^-53 max|.| per halving, and never is more than what is tested against. Signs of g
// at the ends of the arc: exact. Signs at inner ends appear twice and cancel, whatever they are.
//
// References. [Eisermann 2012] for the index as winding number.
//
// Why not real_roots: the roots of g are needed only as far as the sign of h between them tells them apart,
// and their certain isolation costs more than all of this.
#include "poly/roots_detail.hpp"

#include <freiform/core/bounded.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/poly/arc_index.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace freiform {

namespace {

using detail::Integer;
using detail::IntegerPolynomial;

constexpr int kMostHalvings = 64;  // halvings; deeper there is nothing left in a double

int sign_of(double x) { return (x > 0) - (x < 0); }

// y_i - q w_i, all multiplied by one positive number that makes them whole.
IntegerPolynomial differences(std::span<const double> y, std::span<const double> w, double q) {
    int least = 5000;
    const detail::Parts by = detail::parts_of(q);
    const auto weight = [&](std::size_t i) { return detail::parts_of(w.empty() ? 1.0 : w[i]); };
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (y[i] != 0) least = std::min(least, detail::parts_of(y[i]).exponent);
        if (q != 0) least = std::min(least, by.exponent + weight(i).exponent);
    }
    IntegerPolynomial c(y.size());
    for (std::size_t i = 0; i < y.size(); ++i) {
        const detail::Parts a = detail::parts_of(y[i]), b = weight(i);
        if (y[i] != 0) c[i] = detail::shifted(a.m, a.exponent - least);
        if (q != 0)
            c[i] = c[i] - detail::shifted(by.m, by.exponent + b.exponent - least) * detail::integer(b.m);
    }
    return c;
}

// The sign of y - q w.
int exact_sign(double y, double w, double q) {
    if (w == 1) return (y > q) - (y < q);
    const double product = q * w, difference = y - product;
    if (std::abs(difference) > 4 * kUnitRoundoff * (std::abs(y) + std::abs(product)) + 0x1p-1000)
        return sign_of(difference);
    return differences(std::span(&y, 1), std::span(&w, 1), q)[0].sign();
}

// --- with integers
// -----------------------------------------------------------------------------------------------

// -rem(a, b) times a positive number.
IntegerPolynomial negative_remainder(IntegerPolynomial a, const IntegerPolynomial& b) {
    const bool negative = b.back().sign() < 0;
    const Integer size = negative ? detail::negated(b.back()) : b.back();
    while (a.size() >= b.size()) {
        const Integer lead = negative ? detail::negated(a.back()) : a.back();
        const std::size_t shift = a.size() - b.size();
        for (Integer& x : a) x = x * size;
        for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] = a[i + shift] - lead * b[i];
        detail::trim(a);
    }
    for (Integer& x : a) x = detail::negated(x);
    return a;
}

int lowest_sign(const IntegerPolynomial& p) {
    for (const Integer& c : p)
        if (c.sign() != 0) return c.sign();
    return 0;
}

struct Sturm {
    int index = 0;  // of s / r over x in (0, infinity)
    IntegerPolynomial divisor;
};
Sturm sturm(IntegerPolynomial r, IntegerPolynomial s) {
    Sturm out;
    detail::make_primitive(r);
    int low = lowest_sign(r), high = r.empty() ? 0 : r.back().sign();
    while (!s.empty()) {
        detail::make_primitive(s);
        const int l = lowest_sign(s), h = s.back().sign();
        out.index += (low != 0 && l != low) - (high != 0 && h != high);
        low = l, high = h;
        IntegerPolynomial next = r.empty() ? IntegerPolynomial{} : negative_remainder(std::move(r), s);
        r = std::move(s);
        s = std::move(next);
    }
    out.divisor = std::move(r);
    return out;
}

ArcIndex exact_index(std::span<const double> x, std::span<const double> y, std::span<const double> w,
                     const Vec<2>& q) {
    const IntegerPolynomial g_bernstein = differences(y, w, q[1]), h_bernstein = differences(x, w, q[0]);
    const auto meets = [&](std::size_t i) {
        return g_bernstein[i].sign() == 0 && h_bernstein[i].sign() == 0;
    };
    if (meets(0) || meets(y.size() - 1)) return {true, 0};
    IntegerPolynomial g = detail::to_power(g_bernstein), h = detail::to_power(h_bernstein);
    detail::trim(g), detail::trim(h);
    if (g.empty()) {  // along the line through the point
        IntegerPolynomial slope = detail::derivative_of(h);
        return {sturm(h, std::move(slope)).index != 0, 0};
    }
    const int after = lowest_sign(g), before = g.back().sign();
    const int ends = (g_bernstein.front().sign() == 0) * h_bernstein.front().sign() * after -
                     (g_bernstein.back().sign() == 0) * h_bernstein.back().sign() * before;
    Sturm s = sturm(std::move(g), std::move(h));
    if (s.divisor.size() > 1) {
        IntegerPolynomial slope = detail::derivative_of(s.divisor);
        if (sturm(std::move(s.divisor), std::move(slope)).index != 0) return {true, 0};
    }
    return {false, 2 * s.index + ends};
}

// --- with doubles
// ------------------------------------------------------------------------------------------------

// One sign, beyond the error, of all coefficients; 0: not certain.
int common_sign(std::span<const double> c, double error) {
    const int s = sign_of(c[0]);
    for (const double x : c)
        if (!(s * x > error)) return 0;
    return s;
}

struct Piece {
    int depth = 0;
    int from = 0, to = 0;  // signs of g at the ends
    std::vector<double> g, h;
};

// The second half; `c` becomes the first.
std::vector<double> halve(std::vector<double>& c) {
    std::vector<double> right = c;
    const std::size_t n = c.size();
    for (std::size_t r = 1; r < n; ++r) {
        for (std::size_t i = 0; i + r < n; ++i) right[i] = 0.5 * right[i] + 0.5 * right[i + 1];
        c[r] = right[0];
    }
    return right;
}

}  // namespace

ArcIndex arc_index(std::span<const double> x, std::span<const double> y, std::span<const double> w,
                   const Vec<2>& q) {
    const std::size_t n = y.size();
    Piece whole;
    double error_g = 0, error_h = 0, size_g = 0, size_h = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double weight = w.empty() ? 1 : w[i];
        whole.g.push_back(y[i] - q[1] * weight);
        whole.h.push_back(x[i] - q[0] * weight);
        error_g =
            std::max(error_g, 4 * kUnitRoundoff * (std::abs(y[i]) + std::abs(q[1]) * weight) + 0x1p-1000);
        error_h =
            std::max(error_h, 4 * kUnitRoundoff * (std::abs(x[i]) + std::abs(q[0]) * weight) + 0x1p-1000);
        size_g = std::max(size_g, std::abs(whole.g.back())),
        size_h = std::max(size_h, std::abs(whole.h.back()));
    }
    if (!std::isfinite(size_g) || !std::isfinite(size_h)) return exact_index(x, y, w, q);
    const auto end_sign = [&](std::size_t i) { return exact_sign(y[i], w.empty() ? 1 : w[i], q[1]); };
    whole.from = end_sign(0), whole.to = end_sign(n - 1);
    int quarters = 0;
    std::vector<Piece> todo;
    todo.push_back(std::move(whole));
    while (!todo.empty()) {
        Piece p = std::move(todo.back());
        todo.pop_back();
        const double grown = double(n) * p.depth * kUnitRoundoff;
        if (common_sign(p.g, error_g + grown * size_g) != 0) continue;
        if (const int side = common_sign(p.h, error_h + grown * size_h); side != 0) {
            quarters += side * (p.to - p.from);
            continue;
        }
        if (p.depth == kMostHalvings) return exact_index(x, y, w, q);
        Piece second{p.depth + 1, 0, p.to, halve(p.g), halve(p.h)};
        p.to = second.from = sign_of(second.g[0]);
        ++p.depth;
        todo.push_back(std::move(second));
        todo.push_back(std::move(p));
    }
    return {false, quarters};
}

// With d = q - centre = a x + b y: a = (d cross y) / (x cross y), b = (x cross d) / (x cross y), and q is
// inside if a^2 + b^2 < 1.
int ellipse_side(const Vec<2>& centre, const Vec<2>& x, const Vec<2>& y, const Vec<2>& q) {
    const auto side = [&]<class T>(const std::array<T, 2>& d, const std::array<T, 2>& u,
                                   const std::array<T, 2>& v) -> T {
        const auto turn = [](const auto& a, const auto& b) { return a[0] * b[1] - a[1] * b[0]; };
        const T whole = turn(u, v), a = turn(d, v), b = turn(u, d);
        return whole * whole - (a * a + b * b);
    };
    const auto known = [](const Vec<2>& a) { return std::array{Bounded(a[0]), Bounded(a[1])}; };
    const auto c = known(centre), p = known(q);
    const Bounded quick = side(std::array{p[0] - c[0], p[1] - c[1]}, known(x), known(y));
    if (quick.excludes_zero()) return sign_of(quick.value);
    int least = 5000;
    for (const Vec<2>* v : {&centre, &x, &y, &q})
        for (const double z : v->c)
            if (z != 0) least = std::min(least, detail::parts_of(z).exponent);
    const auto whole = [&](const Vec<2>& a) {
        std::array<Integer, 2> w;
        for (std::size_t i = 0; i < 2; ++i)
            if (a.c[i] != 0) {
                const detail::Parts part = detail::parts_of(a.c[i]);
                w[i] = detail::shifted(part.m, part.exponent - least);
            }
        return w;
    };
    const auto wc = whole(centre), wq = whole(q);
    return side(std::array{wq[0] - wc[0], wq[1] - wc[1]}, whole(x), whole(y)).sign();
}

}  // namespace freiform
