// Curves of one to three dimensions as curves of four, the last of which are 0. Modules, which have to be
// small, have what is called seldom for four dimensions alone.
#pragma once
#include <freiform/spline/patch.hpp>

#include <algorithm>
#include <type_traits>

namespace freiform::detail {

inline constexpr int kWidest = 4;
#if defined(__wasm__)
inline constexpr bool kWidens = true;
#else
inline constexpr bool kWidens = false;
#endif

// Whether calls for such coefficients are those for four dimensions.
template <class P>
inline constexpr bool kIsWidened = kWidens&& Space<P>::kDim != kWidest;

template <class P>
using WideOf = std::conditional_t<Space<P>::kRational, Hom<kWidest>, Vec<kWidest>>;

template <class P>
WideOf<P> widened(const P& x) {
    constexpr int D = Space<P>::kDim;
    WideOf<P> out{};
    for (int i = 0; i < D; ++i) out[i] = x[i];
    if constexpr (Space<P>::kRational) out[kWidest] = x.weight();
    return out;
}
template <class P>
Curve<WideOf<P>> widened(const Curve<P>& curve) {
    Net<1, WideOf<P>> net(curve.net().extent());
    for (std::size_t i = 0; i < net.flat().size(); ++i) net.flat()[i] = widened(curve.net().flat()[i]);
    return Curve<WideOf<P>>::trusted(curve.bases(), std::move(net));
}

template <int D>
Vec<D> narrowed(const Vec<kWidest>& x) {
    Vec<D> out;
    for (int i = 0; i < D; ++i) out[i] = x[i];
    return out;
}
template <int D>
Curve<Vec<D>> narrowed(const Curve<Vec<kWidest>>& curve) {
    Net<1, Vec<D>> net(curve.net().extent());
    for (std::size_t i = 0; i < net.flat().size(); ++i) net.flat()[i] = narrowed<D>(curve.net().flat()[i]);
    return Curve<Vec<D>>::trusted(curve.bases(), std::move(net));
}

}  // namespace freiform::detail
