// Leibniz' rule for derivatives of low order, written out when compiling.
#pragma once
#include <freiform/spline/jet.hpp>

#include <array>
#include <utility>

namespace freiform {

inline constexpr int kLowOrder = 3;
inline constexpr double kChoose[kLowOrder + 1][kLowOrder + 1] = {
    {1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};

// Where the derivative i times along u and j times along v stands, in graded order; of curves (N = 1), whose
// only parameter is v, i is 0.
template <std::size_t N = 2>
constexpr std::size_t slot_of(int i, int j) {
    return N == 1 ? std::size_t(j) : std::size_t((i + j) * (i + j + 1) / 2 + j);
}
static_assert(slot_of(2, 0) == jet_slot(Index<2>{2, 0}) && slot_of(1, 2) == jet_slot(Index<2>{1, 2}) &&
              slot_of<1>(0, 3) == jet_slot(Index<1>{3}));

// The terms of a derivative of a product but the one with this derivative of the second factor: `choose`
// times the derivative of the first in slot `part` times that of the second in slot `rest`.
struct LeibnizTerm {
    double choose = 0;
    std::size_t part = 0, rest = 0;
};
template <std::size_t N, int I, int J>
inline constexpr auto kLeibniz = [] {
    std::array<LeibnizTerm, std::size_t((I + 1) * (J + 1) - 1)> out{};
    std::size_t n = 0;
    for (int k = 0; k <= I; ++k)
        for (int l = k == 0 ? 1 : 0; l <= J; ++l)
            out[n++] = {kChoose[I][k] * kChoose[J][l], slot_of<N>(k, l), slot_of<N>(I - k, J - l)};
    return out;
}();

// Calls f.operator()<i, j>() for the derivatives of order kSum, of curves only for the one along v.
template <int kSum, class F>
void each_of_order(bool curve, F&& f) {
    const auto mixed = [&]<int... J>(std::integer_sequence<int, J...>) {
        (f.template operator()<kSum - J, J>(), ...);
    };
    if (!curve) mixed(std::make_integer_sequence<int, kSum>{});
    f.template operator()<0, kSum>();
}
// The same for all orders from kFrom up to `top`. REQUIRES top <= kLowOrder.
template <int kFrom, class F>
void each_derivative(bool curve, int top, F&& f) {
    if (kFrom > top) return;
    each_of_order<kFrom>(curve, f);
    if constexpr (kFrom < kLowOrder) each_derivative<kFrom + 1>(curve, top, f);
}

}  // namespace freiform
