// Splitting, extending and subdividing patches along an axis. The maps of one parameter behind them:
// basis/change.hpp, basis/subdivide.hpp; the construction with all its points: construction.hpp.
#pragma once
#include <freiform/basis/subdivide.hpp>
#include <freiform/spline/patch.hpp>

namespace freiform {

// The parts below and above u, on their parts of the domain, clamped where they meet. Refuses u outside the
// open domain.
//   auto parts = split(curve, 0, 0.5);
template <std::size_t N, class P>
Result<std::array<Patch<N, P>, 2>> split(const Patch<N, P>& s, int axis, double u) {
    const Interval on = s.basis(axis).domain();
    if (!(on.lo < u && u < on.hi))
        return refuse(RefusalKind::out_of_domain, "at",
                      text(u, " is not inside the domain [", on.lo, ", ", on.hi, "]"));
    auto below = restrict_to(s, axis, {on.lo, u}), above = restrict_to(s, axis, {u, on.hi});
    if (!below) return std::unexpected(below.error());
    if (!above) return std::unexpected(above.error());
    return std::array<Patch<N, P>, 2>{std::move(*below), std::move(*above)};
}

// The same map on a larger domain, the end pieces continued. Refuses what extend_to of a basis refuses, and
// rational patches with weights that would not be positive (they have a pole near there).
template <std::size_t N, class P>
Result<Patch<N, P>> extend_to(const Patch<N, P>& s, int axis, Interval on) {
    auto change = extend_to(s.basis(axis), on);
    if (!change) return std::unexpected(change.error());
    auto bases = s.bases();
    bases[std::size_t(axis)] = std::move(change->basis);
    return Patch<N, P>::make(std::move(bases), along(axis, change->map, s.net()));
}

// One knot, by Boehm's algorithm.
template <std::size_t N, class P>
Result<Patch<N, P>> insert_knot(const Patch<N, P>& s, int axis, double u) {
    return rebase(s, axis, insert_knot(s.basis(axis), u));
}

// Every span of a uniform basis halved, by the masks of Lane and Riesenfeld.
template <std::size_t N, class P>
Result<Patch<N, P>> halve_uniform(const Patch<N, P>& s, int axis) {
    return rebase(s, axis, halve_uniform(s.basis(axis)));
}

}  // namespace freiform
