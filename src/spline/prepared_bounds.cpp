// How far what the kernels give is from what is exact.
//
// u = 2^-53, p_d degrees, h_d lengths of spans, parameters inside the domain, c the largest coordinate of a
// control point, w_min and W the smallest and the largest weight; relative roundings, counted.
//
// Functions. The derivative of order o of the functions of an axis is (far / h)^p far^-o sum_k C(p - o, k)
// D_k r^k, D_k = p! / (p - o)! times the o-th differences of the non-negative e_ik (prepared_tables.cpp).
//   r      the distances of x from both ends: 2, the reciprocal 1, the product 1: 4.
//   terms  a coefficient C D_k rounded once from doubled precision (whose error, p 2^-95 of the e_ik, is
//          paid by the factor 1.01 below), and a product and a sum, p - o times: a term has p - o factors
//          r at most, 6 (p - o) + 1.
//   power  far, the inverse of h, their product: 3; p - 1 products of such, and one with the sum: 4 p. At the
//          ends of the span it is exactly 1 and r exactly 0. Degree 0 is exact. 1 / far takes 2 and a
//          product for each order. Together n_d = 10 p_d + 1 at most for p_d > 0, whatever the order.
//   sums   curve: none but those of the functions, whose entries are the coefficients of the piece, each
//          rounded once. Surface: a product and p_d sums along each axis, p_d + 1. Volume: the outer weights
//          are multiplied, then summed in one go: (p_0 + 1) (p_1 + 1) + 1 along the outer two, p_2 + 1.
// Contracted products and sums have fewer. So with k = sum n_d + sums, g = 1.01 k u, a sum is off by at most
// g times the sum of the absolute values of its terms, and by e = h sum (p_d + 1) for underflow with h the
// smallest denormal number, twice since a power may be multiplied with the sum.
//
// Values. The e_ik of one k add up to 1. So |computed - exact| <= g c + e; rational, with numerator and
// denominator off by g c w + e and g w + e,
//     (2 g c + (1 + c) e / w_min) / (1 - g - e / w_min)
// and 2 roundings of the quotient (reciprocal, product) instead of one.
//
// Derivatives. The absolute values of the differences of order o add up to 2^o, so those of the terms to at
// most c T, T = prod_d T_d, T_d = p! / (p - o)! (2 / h_d)^o with h_d the shortest span: |computed - exact| <=
// g c T + e prod_d (2 / h_d)^o. Rational, of orders a: with q = W / w_min
//     w S_a = A_a - sum_{0 < b <= a} C(a, b) w_b S_{a-b},    |A_a| <= c W T_a,  |w_b| <= W T_b,
// so M_a = q (c T_a + sum C(a, b) T_b M_{a-b}), M_0 = c, bounds |S_a|. A_a / w, w_b / w and w are off by g q
// c T_a, g q T_b and g w; a product of the sum has 2 roundings and takes part in 3 differences, the
// quotient 2, the powers of 1 / far after it 4 for each order. So, E_b the errors of the others,
//     E_a <= 1.02 ((2 g + 16 u) M_a + q sum C(a, b) T_b E_{a-b}),
// where 1.02 pays for products of errors (g < 1e-10), and e / w_min times the same sum with M, as above.
//
// Normals. With errors E_u, E_v of the tangents (sqrt 3 times those of their coordinates) the product N = S_u
// x S_v is off by d = E_u |S_v| + E_v |S_u| + E_u E_v + 4 u |S_u| |S_v|, since each component has two
// products and a difference, and the unit vector, whose length has a relative error below 4 u, by 2 d / |N| +
// 4 u.
//
// References: [Higham 2002, ch. 3] counting; [PT97, eq. 4.20] the rule for quotients.
#include "coefficients_detail.hpp"
#include "prepared_detail.hpp"

#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <limits>

namespace freiform::detail {

namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;

// g and e of the head of this file.
struct Counted {
    double relative = 0, lost = 0;
};
Counted counted(std::span<const int> degrees) {
    double roundings = 0, terms = 1;
    for (const int p : degrees) roundings += p > 0 ? 10.0 * p + 1 : 0, terms += 2 * (p + 1);
    if (degrees.size() == 2) roundings += degrees[0] + degrees[1] + 2;
    if (degrees.size() == 3) roundings += (degrees[0] + 1) * (degrees[1] + 1) + degrees[2] + 2;
    return {1.01 * roundings * kUnit, terms * std::numeric_limits<double>::denorm_min()};
}

double shortest_span(const BSplineBasis& basis) {
    double shortest = std::numeric_limits<double>::infinity();
    const int p = basis.degree(), end = int(basis.knots().size()) - p - 1;
    for (int s = p; s < end; ++s)
        if (basis.knot(s) < basis.knot(s + 1))
            shortest = std::min(shortest, basis.knot(s + 1) - basis.knot(s));
    return shortest;
}

// The bounds of all partial derivatives up to order kMaxOrder, in graded order.
template <std::size_t N>
std::vector<double> bounds_of(std::span<const BSplineBasis> bases, const Tuples& net) {
    Index<N> degrees;
    std::array<double, N> steepest;  // 2 / h
    for (std::size_t d = 0; d < N; ++d)
        degrees[d] = bases[d].degree(), steepest[d] = 2 / shortest_span(bases[d]);
    const auto [g, e] = counted(degrees);
    const auto [c, w_min] = reach_of(net);
    const double lost = net.rational ? e / w_min : e;
    double ratio = 1;
    for (std::size_t i = 0; net.rational && i < net.count(); ++i)
        ratio = std::max(ratio, net.weight(i) / w_min);

    const auto orders = jet_orders<N>(kernel::kMaxOrder);
    std::vector<double> terms, vanished, size, bound;  // T, prod (2 / h)^o, M, E
    for (const Index<N>& a : orders) {
        double t = 1, v = 1;
        for (std::size_t d = 0; d < N; ++d)
            for (int i = 0; i < a[d]; ++i) t *= (degrees[d] - i) * steepest[d], v *= steepest[d];
        terms.push_back(t), vanished.push_back(v);
    }
    for (std::size_t s = 0; s < orders.size(); ++s) {
        if (!net.rational || s == 0) {
            size.push_back(c);
            bound.push_back(s == 0 ? batch_error_bound(degrees, net)
                                   : g * c * terms[s] + lost * (1 + c) * vanished[s]);
            continue;
        }
        double m = ratio * c * terms[s], others = 0, denormals = (1 + c) * vanished[s];
        for (std::size_t b = 1; b <= s; ++b) {
            Index<N> rest;
            double times = 1;
            for (std::size_t d = 0; d < N; ++d)
                rest[d] = orders[s][d] - orders[b][d], times *= binomial(orders[s][d], orders[b][d]);
            if (times == 0) continue;
            const std::size_t r = jet_slot(rest);
            m += ratio * times * terms[b] * size[r];
            others += ratio * times * terms[b] * bound[r];
            denormals += times * vanished[b] * size[r];
        }
        size.push_back(m);
        bound.push_back(1.02 * ((2 * g + 16 * kUnit) * m + others + lost * denormals));
    }
    return bound;
}

}  // namespace

double batch_error_bound(std::span<const int> degrees, const Tuples& net) {
    const auto [g, lost] = counted(degrees);
    const auto [c, w_min] = reach_of(net);
    if (!net.rational) return g * c + lost;
    return 1.02 * ((2 * g + 2 * kUnit) * c + (1 + c) * (lost / w_min)) + lost;
}

std::vector<double> batch_error_bounds(std::span<const BSplineBasis> bases, const Tuples& net) {
    if (bases.size() == 1) return bounds_of<1>(bases, net);
    return bases.size() == 2 ? bounds_of<2>(bases, net) : bounds_of<3>(bases, net);
}

}  // namespace freiform::detail
