// Boolean sums of two families of curves.
//
// Idea: all three terms are tensor products on the same two bases, so the nets add up. Coefficient (i, j) is
//     sum_k h_kj a_ki + sum_l g_li (b_lj - sum_k h_kj T_kl),
// in which the second sum vanishes without rounding where h_j is a unit vector and b_lj = T_kl.
//
// Rational curves a_k = A_k / w(u), b_l = B_l / x(v): times w x, each term is one of the same kind, with the
// numerators for curves and x h_k, w g_l for functions. The weights w_i x_j are positive.
//
// Powers: the coefficient of x^m on a basis of degree p is its blossom, the mean of the products of m of the
// p knots t_{i+1} .. t_{i+p}: the elementary symmetric polynomial e_m divided by p over m [Ramshaw 1989].
// All terms are >= 0, so nothing cancels.
//
// References: [Gordon 1969], [Farin 2002, ch. 22].
#include "rounding_detail.hpp"

#include <freiform/make/boolean_sum.hpp>

#include <algorithm>

namespace freiform {

namespace {

// Calls add(i, j, coefficient) for the whole net.
template <class F>
void each_sum(const BlendedFamily& u, const BlendedFamily& v,
              const std::vector<std::vector<BoundedVec<3>>>& T, F&& add) {
    std::vector<BoundedVec<3>> rest(v.curves.size());  // b_lj - sum_k h_kj T_kl
    for (int j = 0; j < v.basis.size(); ++j) {
        const std::size_t J = std::size_t(j);
        for (std::size_t l = 0; l < rest.size(); ++l) {
            rest[l] = v.curves[l][J];
            for (std::size_t k = 0; k < u.curves.size(); ++k)
                for (std::size_t c = 0; c < 3; ++c) rest[l][c] -= u.functions[k][J] * T[k][l][c];
        }
        for (int i = 0; i < u.basis.size(); ++i) {
            const std::size_t I = std::size_t(i);
            BoundedVec<3> sum{};
            for (std::size_t k = 0; k < u.curves.size(); ++k)
                for (std::size_t c = 0; c < 3; ++c) sum[c] += u.functions[k][J] * u.curves[k][I][c];
            for (std::size_t l = 0; l < rest.size(); ++l)
                for (std::size_t c = 0; c < 3; ++c) sum[c] += v.functions[l][I] * rest[l][c];
            add(i, j, sum);
        }
    }
}

template <class Q>
Result<MadeSurface<Q>> made(const BSplineBasis& u, const BSplineBasis& v, Net<2, Q> net, double bound) {
    auto surface = Surface<Q>::make({u, v}, std::move(net));
    if (!surface) return std::unexpected(surface.error());
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "curves", "rounding leaves nothing of their sum");
    return MadeSurface<Q>{std::move(*surface), bound};
}

}  // namespace

Result<MadeSurface<Vec<3>>> boolean_sum(const BlendedFamily& u, const BlendedFamily& v,
                                        const std::vector<std::vector<BoundedVec<3>>>& T) {
    Net<2, Vec<3>> net({u.basis.size(), v.basis.size()});
    double moved = 0;
    each_sum(u, v, T, [&](int i, int j, const BoundedVec<3>& sum) {
        Vec<3> p, e;
        for (int c = 0; c < 3; ++c) p[c] = sum[std::size_t(c)].value, e[c] = sum[std::size_t(c)].bound;
        net.view()({i, j}) = p;
        moved = std::max(moved, norm(e));
    });
    return made(u.basis, v.basis, std::move(net), moved * (1 + 0x1p-48));
}

Result<MadeSurface<Hom<3>>> boolean_sum(const OverOne& u, const OverOne& v,
                                        const std::vector<std::vector<BoundedVec<3>>>& T) {
    Net<2, Hom<3>> net({u.basis.size(), v.basis.size()});
    detail::MovedBound moved;
    each_sum({u.basis, u.curves, v.functions}, {v.basis, v.curves, u.functions}, T,
             [&](int i, int j, const BoundedVec<3>& sum) {
                 const Bounded w = u.denominator[std::size_t(i)] * v.denominator[std::size_t(j)];
                 Hom<3>& h = net.view()({i, j});
                 Vec<3> e;
                 for (int c = 0; c < 3; ++c)
                     h[c] = sum[std::size_t(c)].value, e[c] = sum[std::size_t(c)].bound / w.value;
                 h[3] = w.value;
                 moved.add(project(h), norm(e) * (1 + 0x1p-48), w.bound / w.value);
             });
    return made(u.basis, v.basis, std::move(net), moved.value());
}

std::vector<std::vector<Bounded>> powers_on(const BSplineBasis& basis, int most) {
    FF_REQUIRE(!basis.is_closed() && basis.degree() >= most);
    const Interval on = basis.domain();
    const Bounded length = Bounded(on.hi) - Bounded(on.lo);
    std::vector<std::vector<Bounded>> out(std::size_t(most) + 1);
    for (int i = 0; i < basis.size(); ++i) {
        std::vector<Bounded> e(std::size_t(most) + 1, Bounded(0));
        e[0] = 1;
        for (int k = 1; k <= basis.degree(); ++k) {
            const Bounded x = (Bounded(basis.knot(i + k)) - Bounded(on.lo)) / length;
            for (std::size_t q = std::size_t(most); q > 0; --q) e[q] += x * e[q - 1];
        }
        for (std::size_t q = 0; q < e.size(); ++q)
            out[q].push_back(e[q] / Bounded(binomial(basis.degree(), int(q))));
    }
    return out;
}

}  // namespace freiform
