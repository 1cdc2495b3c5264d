// Exact signs of the orientation and in-circle determinants.
//
// Idea. Nearly always a few double operations and a bound on their rounding settle the sign. Otherwise the
// same determinant is computed without any rounding, as a sum of doubles that do not overlap (an expansion);
// and where the exponents are too far apart for that, in integers of any length.
//
// Notation. u = 2^-53, half the distance from 1 to the next double; fl(x) is x rounded, and (1 + d), |d| <=
// u, the factor of one rounding. With differences from the last point,
//     orient2d(a, b, c)     = L - R,  L = (ax - cx)(by - cy),  R = (ay - cy)(bx - cx)
//     in_circle(a, b, c, d) = |a-d|^2 (b-d)x(c-d) + |b-d|^2 (c-d)x(a-d) + |c-d|^2 (a-d)x(b-d)
//
// Method and accuracy, stage by stage.
// 1. Filter, orient2d. Sums and differences never underflow inexactly, so the computed L' has three factors
// (1 + d)
//    and, if its product underflows, an absolute error of at most 2^-1075. Let s' = fl(|L'| + |R'|). If
//    s' > 2^-900, underflow is below 2^-170 of s' in all, and |(L - R) - (L' - R')| <= (3u + 7u^2)(|L'| +
//    |R'|). The sign of fl(L' - R') is that of L' - R', and |fl(L' - R')| > 4u s' implies |L' - R'| > 4u (1 -
//    u)(1 - u)(|L'| + |R'|), which is more than that error. An overflow makes s' infinite or NaN and the
//    comparison false. If s' = 0 because in each product a *difference* is zero, then L = R = 0: differences
//    are zero only for equal numbers.
// 2. Filter, in_circle. Each of the six products in a minor carries at most four factors (two differences,
// product,
//    sum), each lift |.|^2 too, their product one and the two sums two more: at most 11 in all. So the error
//    is at most ((1 + u)^11 - 1) P < 11.1u P, P = sum of lift * (sum of the two |products|), and the computed
//    P' is at least P (1 - u)^11; 16u P' exceeds the error. Underflow: with S' = sum of the lifts, minors are
//    at most S' (arithmetic and geometric mean), so underflow (eta = 2^-1075 each) adds at most 3 (2 eta S' +
//    2 eta S' + 2 eta)(1 + small) < 2^-1070 (1 + S'), which is less than 2^-110 P' if P' > 2^-960 (1 + S').
//    The gap from 11.1u to 16u covers it. Rectangles parallel to the axes, which grids are full of, are told
//    by comparing coordinates.
// 3. Expansions [Shewchuk 1997]: two_sum, and two_product by fma, give the rounding error as a second double;
// sums of
//    two expansions (his theorem 13, with zeros left out) and products with a double (theorem 19) keep the
//    parts strongly nonoverlapping, so the last part has the sign of the sum. All this is exact **if nothing
//    over- or underflows**, which we make sure of: all coordinates are first multiplied by one power of two,
//    which changes no sign.
//      orient2d: the largest coordinate is moved to [2^500, 2^501). If the smallest (not zero) is then at
//      least
//        2^-460, all are multiples of 2^-512, products and every part of every sum are multiples of 2^-1024,
//        hence doubles without underflow; and nothing exceeds 6 * 2^1002. Window: exponents up to 960 apart.
//      in_circle: largest to [2^250, 2^251), smallest at least 2^-216: multiples of 2^-268, of degree 4:
//      2^-1072;
//        nothing exceeds 3 * 2^505 * 2^505 = 3 * 2^1010. Window: exponents up to 466 apart.
//    Multiplying by the power is exact: the result has the same significant bits and is not subnormal.
//    The filter is tried again after scaling, so that coordinates near 2^300 are hardly slower than near 1.
// 4. Integers. Coordinates divided by the smallest power of two in use are integers of at most 2 152 bits;
// sums and
//    products of those in limbs of 32 bits, by the method of school, are exact by construction.
// Rounding is to nearest even throughout, and nothing may be contracted or reordered (-ffp-contract=off, no
// fast-math).
//
// Cost. Stage 1 about 15, stage 2 about 40 operations. Expansions drop zero parts, so points on a grid, the
// frequent degenerate case, stay short. The worst in_circle has 3 * 512 parts.
//
// References. [Shewchuk 1997].
//
// Why not his adaptive stages B and C between filter and full expansion? They triple the code. The case that
// they make faster, long expansions, is met by zero elimination as far as grids go.
#include "poly/predicates_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace freiform {

namespace detail {

namespace {

int sign_of(double x) { return (x > 0) - (x < 0); }

// Whether d = fl(a - b) is a - b.
bool is_difference(double d, double a, double b) {
    const double b1 = d - a;
    return (a - (d - b1)) - (b + b1) == 0;
}

// The filters of stage 1 and 2: the sign, or 0 where they say nothing.
int clear_orientation(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    const double det = left - right, size = std::abs(left) + std::abs(right);
    if (!(std::abs(det) > 4 * kUnitRoundoff * size && size > 0x1p-900)) return 0;
    return det > 0 ? 1 : -1;
}
// `det`: the rounded determinant.
int clear_place(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d, double& det) {
    const double ax = a[0] - d[0], ay = a[1] - d[1], bx = b[0] - d[0], by = b[1] - d[1], cx = c[0] - d[0],
                 cy = c[1] - d[1];
    const double bc = bx * cy, cb = by * cx, ca = cx * ay, ac = cy * ax, ab = ax * by, ba = ay * bx;
    const double la = ax * ax + ay * ay, lb = bx * bx + by * by, lc = cx * cx + cy * cy;
    det = la * (bc - cb) + lb * (ca - ac) + lc * (ab - ba);
    const double size = la * (std::abs(bc) + std::abs(cb)) + lb * (std::abs(ca) + std::abs(ac)) +
                        lc * (std::abs(ab) + std::abs(ba));
    if (!(std::abs(det) > 16 * kUnitRoundoff * size && size > 0x1p-960 * (1 + la + lb + lc))) return 0;
    return det > 0 ? 1 : -1;
}

// --- expansions --------------------------------------------------------------------------------------------

struct Two {
    double high, low;
};
Two two_sum(double a, double b) {
    const double x = a + b, b1 = x - a, a1 = x - b1;
    return {x, (a - a1) + (b - b1)};
}
Two two_product(double a, double b) {
    const double x = a * b;
    return {x, std::fma(a, b, -x)};
}

// A number as the sum of `size` doubles, none zero, strongly nonoverlapping, in order of rising magnitude.
template <int Capacity>
struct Expansion {
    std::array<double, std::size_t(Capacity)> part;
    int size = 0;

    void push(double x) {
        if (x != 0) part[std::size_t(size++)] = x;
    }
    double operator[](int i) const { return part[std::size_t(i)]; }
    int sign() const { return size == 0 ? 0 : sign_of(part[std::size_t(size - 1)]); }
};

Expansion<2> difference(double a, double b) {
    const Two d = two_sum(a, -b);
    Expansion<2> e;
    e.push(d.low);
    e.push(d.high);
    return e;
}

// h = e + f.
template <int C, int A, int B>
void add(const Expansion<A>& e, const Expansion<B>& f, Expansion<C>& h) {
    h.size = 0;
    double q = 0;
    for (int i = 0, j = 0; i < e.size || j < f.size;) {
        const bool from_e = j == f.size || (i < e.size && std::abs(e[i]) < std::abs(f[j]));
        const Two s = two_sum(q, from_e ? e[i++] : f[j++]);
        h.push(s.low);
        q = s.high;
    }
    h.push(q);
}

template <int A>
Expansion<2 * A> scaled(const Expansion<A>& e, double b) {
    Expansion<2 * A> h;
    double q = 0;
    for (int i = 0; i < e.size; ++i) {
        const Two t = two_product(e[i], b);
        const Two s = two_sum(q, t.low);
        h.push(s.low);
        const Two r = two_sum(t.high, s.high);
        h.push(r.low);
        q = r.high;
    }
    h.push(q);
    return h;
}

template <int A, int B>
Expansion<A + B> sum(const Expansion<A>& e, const Expansion<B>& f) {
    Expansion<A + B> h;
    add(e, f, h);
    return h;
}

template <int A>
Expansion<A> negative(Expansion<A> e) {
    for (int i = 0; i < e.size; ++i) e.part[std::size_t(i)] = -e[i];
    return e;
}

template <int A, int B>
Expansion<2 * A * B> product(const Expansion<A>& e, const Expansion<B>& f) {
    Expansion<2 * A * B> h, g;
    for (int j = 0; j < f.size; ++j) {
        add(h, scaled(e, f[j]), g);
        std::copy_n(g.part.begin(), g.size, h.part.begin());
        h.size = g.size;
    }
    return h;
}

// Scales all points by the power of two that moves the largest coordinate to exponent `top`. False, and
// nothing done, if the exponents are more than `spread` apart.
template <std::size_t N>
bool normalise(PlanePoints<N>& points, int top, int spread) {
    int most = -5000, least = 5000;
    for (const Vec<2>& p : points)
        for (const double x : p.c)
            if (x != 0) most = std::max(most, std::ilogb(x)), least = std::min(least, std::ilogb(x));
    if (most - least > spread) return false;
    for (Vec<2>& p : points)
        for (double& x : p.c) x = x == 0 ? 0 : std::scalbn(x, top - most);
    return true;
}

template <std::size_t N>
int sign_of_determinant(const PlanePoints<N>& p) {
    if (const auto s = filtered_sign(p)) return *s;
    for (const Vec<2>& q : p)
        if (!is_finite(q)) return 0;
    if (const auto s = expansion_sign(p)) return *s;
    return integer_sign(p);
}

}  // namespace

std::optional<int> filtered_sign(const PlanePoints<3>& p) {
    const auto& [a, b, c] = p;
    if (const int s = clear_orientation(a, b, c); s != 0) return s;
    const double ax = a[0] - c[0], ay = a[1] - c[1], bx = b[0] - c[0], by = b[1] - c[1];
    if ((ax == 0 || by == 0) && (ay == 0 || bx == 0)) return 0;
    const bool exact = is_difference(ax, a[0], c[0]) && is_difference(ay, a[1], c[1]) &&
                       is_difference(bx, b[0], c[0]) && is_difference(by, b[1], c[1]);
    const Two left = two_product(ax, by), right = two_product(ay, bx);
    const auto is_whole = [](const Two& t) {
        return t.low == 0 && (t.high == 0 || std::abs(t.high) > 0x1p-900);
    };
    if (exact && is_whole(left) && is_whole(right) && !(left.high == 0 && ax != 0 && by != 0) &&
        !(right.high == 0 && ay != 0 && bx != 0))
        return (left.high > right.high) - (left.high < right.high);
    return std::nullopt;
}

// Whether these few differences are exact and so short that no rounding can happen in in_circle: multiples of
// 2^(e - 11), e the largest exponent among them, so below 2^12 of these. Lifts and minors are below 2^25,
// their products below 2^50, and all sums below 2^52 of their units.
bool are_short(const PlanePoints<4>& p) {
    std::array<double, 6> difference;
    double most = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        difference[i] = p[i / 2].c[i % 2] - p[3].c[i % 2];
        most = std::max(most, std::abs(difference[i]));
    }
    if (!(most > 0x1p-200 && most < 0x1p200)) return false;
    const double c = std::ldexp(1.5, std::ilogb(most) - 11 + 52);
    for (std::size_t i = 0; i < 6; ++i)
        if ((difference[i] + c) - c != difference[i] ||
            !is_difference(difference[i], p[i / 2].c[i % 2], p[3].c[i % 2]))
            return false;
    return true;
}

// Corners of an axis-parallel rectangle in any order: one pairing has equal x, another equal y. They lie on a
// circle (or on a line, or two are equal); grids are made of them.
bool is_rectangle(const PlanePoints<4>& p) {
    constexpr std::size_t kPairing[3][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}};
    const auto paired = [&](std::size_t i, int k) {
        const auto& n = kPairing[i];
        return p[n[0]][k] == p[n[1]][k] && p[n[2]][k] == p[n[3]][k];
    };
    for (std::size_t i = 0; i < 3; ++i)
        if (paired(i, 0)) return paired((i + 1) % 3, 1) || paired((i + 2) % 3, 1);
    return false;
}

std::optional<int> filtered_sign(const PlanePoints<4>& p) {
    double det = 0;
    if (const int s = clear_place(p[0], p[1], p[2], p[3], det); s != 0) return s;
    if (is_rectangle(p)) return 0;
    if (are_short(p)) return sign_of(det);
    return std::nullopt;
}

std::optional<int> expansion_sign(PlanePoints<3> p) {
    if (!normalise(p, 500, 960)) return std::nullopt;
    if (const auto s = filtered_sign(p)) return *s;
    const auto& [a, b, c] = p;
    const auto minor = [](const Vec<2>& q, const Vec<2>& r) {
        Expansion<2> left, right;
        const Two l = two_product(q[0], r[1]), m = two_product(q[1], r[0]);
        left.push(l.low), left.push(l.high);
        right.push(-m.low), right.push(-m.high);
        return sum(left, right);
    };
    return sum(sum(minor(a, b), minor(b, c)), minor(c, a)).sign();
}

std::optional<int> expansion_sign(PlanePoints<4> p) {
    if (!normalise(p, 250, 466)) return std::nullopt;
    if (const auto s = filtered_sign(p)) return *s;
    std::array<std::array<Expansion<2>, 2>, 3> v;  // the first three points seen from the last
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 2; ++k) v[i][k] = difference(p[i].c[k], p[3].c[k]);
    const auto term = [&](std::size_t i, std::size_t j, std::size_t k) {
        const auto lift = sum(product(v[i][0], v[i][0]), product(v[i][1], v[i][1]));
        const auto minor = sum(product(v[j][0], v[k][1]), negative(product(v[j][1], v[k][0])));
        return product(lift, minor);
    };
    return sum(sum(term(0, 1, 2), term(1, 2, 0)), term(2, 0, 1)).sign();
}

}  // namespace detail

int orient2d(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
    if (const int s = detail::clear_orientation(a, b, c); s != 0) return s;
    return detail::sign_of_determinant<3>({a, b, c});
}

int in_circle(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
    double det = 0;
    if (const int s = detail::clear_place(a, b, c, d, det); s != 0) return s;
    return detail::sign_of_determinant<4>({a, b, c, d});
}

bool is_between(const Vec<2>& a, const Vec<2>& b, const Vec<2>& p) {
    const int k = a[0] == b[0] ? 1 : 0;
    return ((a[k] < p[k] && p[k] < b[k]) || (b[k] < p[k] && p[k] < a[k])) && is_finite(a) && is_finite(b) &&
           is_finite(p) && orient2d(a, b, p) == 0;
}

bool segments_cross(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
    return orient2d(a, b, c) * orient2d(a, b, d) < 0 && orient2d(c, d, a) * orient2d(c, d, b) < 0;
}

}  // namespace freiform
