// Jets: the value and all partial derivatives up to a total order, in graded order.
//
//     N = 1:  f, f', f'', ...           N = 2:  S, Su, Sv, Suu, Suv, Svv, Suuu, ...
#pragma once
#include <freiform/core/hom.hpp>
#include <freiform/core/net.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace freiform {

// A parameter of a curve is a plain number, of a surface a pair, of a volume a triple.
template <std::size_t N>
using Param = std::conditional_t<N == 1, double, std::array<double, N>>;

template <std::size_t N>
constexpr double component(const Param<N>& u, std::size_t axis) {
    if constexpr (N == 1)
        return (void)axis, u;
    else
        return u[axis];
}

// n over k, exact as long as it is below 2^53.
constexpr double binomial(int n, int k) {
    if (k < 0 || k > n) return 0;
    double r = 1;
    for (int i = 1; i <= k; ++i) r = r * (n - k + i) / i;
    return r;
}

// Number of partial derivatives of N variables up to total order K.
constexpr std::size_t jet_size(std::size_t n, int order) {
    return std::size_t(binomial(int(n) + order, int(n)) + 0.5);
}

// Place of the partial derivative (a_0, .., a_{N-1}) in the graded order.
template <std::size_t N>
constexpr std::size_t jet_slot(const Index<N>& a) {
    std::size_t slot = 0;
    int rest = 0;
    for (std::size_t d = N; d-- > 0;) {  // rank among those of the same tail sum, from the last axis inwards
        rest += a[d];
        slot += std::size_t(binomial(int(N - d) - 1 + rest, int(N - d)) + 0.5);
    }
    return slot;
}

// All orders (a_0, .., a_{N-1}) of total order <= K, in graded order.
template <std::size_t N>
constexpr std::vector<Index<N>> jet_orders(int order) {
    std::vector<Index<N>> all(jet_size(N, order));
    Index<N> extent{};
    for (auto& e : extent) e = order + 1;
    each_index(extent, [&](const Index<N>& at) {
        int sum = 0;
        for (int x : at) sum += x;
        if (sum <= order) all[jet_slot(at)] = at;
    });
    return all;
}

template <std::size_t N, int K, class V>
struct Jet {
    std::array<V, jet_size(N, K)> d{};

    const V& value() const { return d[0]; }
    const V& operator()(const Index<N>& orders) const { return d[jet_slot(orders)]; }
    template <std::convertible_to<int>... I>
    requires(sizeof...(I) == N) const V& operator()(I... orders) const {
        return d[jet_slot(Index<N>{int(orders)...})];
    }
};

// Projects the partial derivatives h (graded order, up to total order `order`) of a homogeneous function to
// those of the point function: the quotient rule for every order and every N at once,
//     S_a = (A_a - sum_{0 < b <= a} C(a, b) w_b S_{a-b}) / w_0                               [PT97,
//     eq. 4.8, 4.20]
template <std::size_t N, class P>
void project_jet(int order, std::span<const P> h, std::span<PointOf<P>> out) {
    if constexpr (!Space<P>::kRational) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = h[i];
    } else {
        constexpr int D = Space<P>::kDim;
        Index<N> extent{};
        for (auto& e : extent) e = order + 1;
        // Graded order means that S_{a-b} is there before S_a; walk by total order.
        for (int total = 0; total <= order; ++total)
            each_index(extent, [&](const Index<N>& a) {
                int sum = 0;
                for (int x : a) sum += x;
                if (sum != total) return;
                const std::size_t slot = jet_slot(a);
                Vec<D> v;
                for (int i = 0; i < D; ++i) v[i] = h[slot][i];
                Index<N> below{};
                for (std::size_t d = 0; d < N; ++d) below[d] = a[d] + 1;
                each_index(below, [&](const Index<N>& b) {
                    double c = 1;
                    Index<N> rest{};
                    bool zero = true;
                    for (std::size_t d = 0; d < N; ++d) {
                        c *= binomial(a[d], b[d]);
                        rest[d] = a[d] - b[d];
                        zero = zero && b[d] == 0;
                    }
                    if (!zero) v -= (c * h[jet_slot(b)].weight()) * out[jet_slot(rest)];
                });
                for (int i = 0; i < D; ++i) out[slot][i] = v[i] / h[0].weight();
            });
    }
}

}  // namespace freiform
