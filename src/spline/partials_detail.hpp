// Partial derivatives of curves and surfaces at one place.
#pragma once
#include "leibniz_detail.hpp"

#include <freiform/basis/blossom.hpp>
#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <kernel/blocks.hpp>
#include <span>

namespace freiform::detail {

// Derivatives of low orders are asked for one place at a time, over and over: they are found with what they
// share done once, bit for bit as weights_in_span, `contract` and project_jet say.

// The knots that matter in a span, of a basis whose degree is known when compiling.
template <int P>
struct KnotsAround {
    static constexpr int kSpan = P - 1;  // here
    double at[2 * P];

    template <Basis B>
    KnotsAround(const B& basis, int span) {
        for (int i = 0; i < 2 * P; ++i) at[i] = basis.knot(span - kSpan + i);
    }
    constexpr int degree() const { return P; }
    double knot(int i) const { return at[i]; }
};

// f(0) .. f(count - 1), one after the other where the number is known when compiling (Count >= 0).
template <int Count, class F>
inline __attribute__((always_inline)) void each_of(int count, F f) {
    if constexpr (Count >= 0) [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
            (f(I), ...);
        }
    (std::make_integer_sequence<int, Count>{});
    else for (int i = 0; i < count; ++i) f(i);
}

// blossom_step, bit for bit, with both quotients at once: they take most of the time.
template <class B>
inline void quick_step(const B& basis, int span, int k, double x, double* b) {
#if defined(__GNUC__) && !defined(__wasm__)
    using Two = double __attribute__((vector_size(16)));
    double carry = 0;
    for (int r = 0; r < k; ++r) {
        const double tl = basis.knot(span + 1 - k + r), tr = basis.knot(span + 1 + r), old = b[r];
        const Two part = Two{tr - x, x - tl} / Two{tr - tl, tr - tl};
        b[r] = carry + old * part[0];
        carry = old * part[1];
    }
    b[k] = carry;
#else
    blossom_step(basis, span, k, x, b);
#endif
}

// P: the degree; -1: of any.
template <int P, class B>
inline void weights_with(const B& basis, int span, double u, int order, std::ptrdiff_t stride, double* w) {
    constexpr int kMost = P < 0 ? kMaxDegree : P;
    const int p = P < 0 ? basis.degree() : P;
    double b[kMost + 1];
    b[0] = 1;
    for (int r = p + 1; r <= order; ++r) std::fill_n(w + r * stride, p + 1, 0.0);
    each_of < P<0 ? -1 : P + 1>(
                  p + 1,
                  [&](int k) __attribute__((always_inline)) {
                      if (k > 0) quick_step(basis, span, k, u, b);
                      if (p - k > order) return;
                      double* const row = w + (p - k) * stride;
                      for (int i = 0; i <= k; ++i) row[i] = b[i];
                      each_of<P>(
                          p, [&](int below) __attribute__((always_inline)) {
                              const int m = below + 1;
                              if (m <= k) return;
                              derivative_step(basis, span, m, row);
                              for (int i = 0; i <= m; ++i) row[i] *= m;
                          });
                  });
}

// The weights of all orders up to `order`, those of order r at w + r * stride.
template <Basis B>
void weights_up_to(const B& basis, int span, double u, int order, std::ptrdiff_t stride, double* w) {
#if !defined(__wasm__)  // for size
    constexpr int kUnrolled = 10;
    const bool done = [&]<int... Less>(std::integer_sequence<int, Less...>) {
        const auto with = [&]<int P>(const KnotsAround<P>& around) {
            weights_with<P>(around, KnotsAround<P>::kSpan, u, order, stride, w);
            return true;
        };
        return ((basis.degree() == Less + 1 && with(KnotsAround<Less + 1>(basis, span))) || ...);
    }
    (std::make_integer_sequence<int, kUnrolled>{});
    if (done) return;
#endif
    weights_with<-1>(basis, span, u, order, stride, w);
}

// All sums up to total order `order`, in graded order. Those along the last axis serve all orders along the
// first. `w`: the weights of each order along each axis, `stride` apart.
template <std::size_t N, class P>
requires(N <= 2) void contract_all(const NetView<N, const P>& net, const std::array<const double*, N>& w,
                                   std::ptrdiff_t stride, const Index<N>& first, const Index<N>& count,
                                   int order, P* out) {
    constexpr std::size_t last = N - 1;
    const auto sum_along = [&](const P* row, int a) {
        const double* const weight = w[last] + a * stride;
        P sum{};
        int i = first[last];
        for (int k = 0; k < count[last]; ++k) {
            const P& p = row[i * net.stride[last]];
            for (int c = 0; c < P::kCoords; ++c) sum[c] += weight[k] * p[c];
            if (++i == net.extent[last]) i = 0;  // closed bases wrap; the others end here
        }
        return sum;
    };
    if constexpr (N == 1) {
        for (int a = 0; a <= order; ++a) out[a] = sum_along(net.data, a);
    } else if (P::kCoords == 4 && order <= 3) {
        kernel::block_kernels().contract({net.data->c.data(),
                                          {net.stride[0] * 4, net.stride[1] * 4},
                                          {first[0], first[1]},
                                          {count[0], count[1]},
                                          {net.extent[0], net.extent[1]},
                                          {w[0], w[1]},
                                          stride,
                                          order},
                                         out->c.data());
    } else {
        std::fill_n(out, std::size_t((order + 1) * (order + 2) / 2), P{});
        int i = first[0];
        for (int k = 0; k < count[0]; ++k) {
            for (int b = 0; b <= order; ++b) {
                const P inner = sum_along(net.data + i * net.stride[0], b);
                for (int a = 0; a + b <= order; ++a) {
                    P& sum = out[(a + b) * (a + b + 1) / 2 + b];
                    const double weight = w[0][a * stride + k];
                    for (int c = 0; c < P::kCoords; ++c) sum[c] += weight * inner[c];
                }
            }
            if (++i == net.extent[0]) i = 0;
        }
    }
}

// project_jet up to order 3.
template <std::size_t N, class P>
requires(N <= 2 && Space<P>::kRational) void project_low(int order, const P* h, std::span<PointOf<P>> out) {
    each_derivative<0>(N == 1, order, [&]<int I, int J>() {
        if constexpr (N == 2 || I == 0) {
            constexpr std::size_t slot = slot_of<N>(I, J);
            PointOf<P> v;
            for (int c = 0; c < v.kCoords; ++c) v[c] = h[slot][c];
            for (const LeibnizTerm& t : kLeibniz<N, I, J>) v -= (t.choose * h[t.part].weight()) * out[t.rest];
            for (int c = 0; c < v.kCoords; ++c) out[slot][c] = v[c] / h[0].weight();
        }
    });
}

}  // namespace freiform::detail
