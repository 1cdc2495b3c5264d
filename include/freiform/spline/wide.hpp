// Splines of one to three dimensions as those of four, the last of which are 0. Modules, which have to be
// small, have what is called seldom for four dimensions alone.
#pragma once
#include <freiform/spline/patch.hpp>

#include <span>
#include <type_traits>
#include <vector>

namespace freiform::detail {

inline constexpr int kWidest = 4;
#if defined(__wasm__)
inline constexpr bool kWidens = true;
#else
inline constexpr bool kWidens = false;
#endif

// Whether calls for such coefficients are those for four dimensions.
template <class P>
inline constexpr bool kIsWidened = Space<P>::kDim < kWidest ? kWidens : false;

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
template <std::size_t N, class P>
Patch<N, WideOf<P>> widened(const Patch<N, P>& patch) {
    Net<N, WideOf<P>> net(patch.net().extent());
    for (std::size_t i = 0; i < net.flat().size(); ++i) net.flat()[i] = widened(patch.net().flat()[i]);
    return Patch<N, WideOf<P>>::trusted(patch.bases(), std::move(net));
}
template <int D>
std::vector<Vec<kWidest>> widened(std::span<const Vec<D>> points) {
    std::vector<Vec<kWidest>> out;
    for (const Vec<D>& p : points) out.push_back(widened(p));
    return out;
}

template <int D>
Vec<D> narrowed(const Vec<kWidest>& x) {
    Vec<D> out;
    for (int i = 0; i < D; ++i) out[i] = x[i];
    return out;
}
template <int D, std::size_t N>
Patch<N, Vec<D>> narrowed(const Patch<N, Vec<kWidest>>& patch) {
    Net<N, Vec<D>> net(patch.net().extent());
    for (std::size_t i = 0; i < net.flat().size(); ++i) net.flat()[i] = narrowed<D>(patch.net().flat()[i]);
    return Patch<N, Vec<D>>::trusted(patch.bases(), std::move(net));
}

}  // namespace freiform::detail
