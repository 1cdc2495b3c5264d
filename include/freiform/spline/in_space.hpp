// Plane and linear patches as patches in space: the coordinates that are missing are 0.
#pragma once
#include <freiform/spline/patch.hpp>

#include <type_traits>

namespace freiform {

// Of the same kind, polynomial or rational, with three coordinates.
template <class P>
using InSpace = std::conditional_t<Space<P>::kRational, Hom<3>, Vec<3>>;

template <class P>
requires(Space<P>::kDim <= 3) InSpace<P> in_space(const P& p) {
    InSpace<P> q{};
    for (int i = 0; i < Space<P>::kDim; ++i) q[i] = p[i];
    if constexpr (Space<P>::kRational) q[3] = p.weight();
    return q;
}

template <std::size_t N, class P>
requires(Space<P>::kDim <= 3) Patch<N, InSpace<P>> in_space(const Patch<N, P>& patch) {
    std::vector<InSpace<P>> c;
    for (const P& p : patch.net().flat()) c.push_back(in_space(p));
    return Patch<N, InSpace<P>>::trusted(patch.bases(),
                                         Net<N, InSpace<P>>(patch.net().extent(), std::move(c)));
}

}  // namespace freiform
