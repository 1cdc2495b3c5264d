// Splitting, extending and subdividing patches along an axis. The maps of one parameter behind them:
// basis/change.hpp, basis/subdivide.hpp; the construction with all its points: construction.hpp.
#pragma once
#include <freiform/basis/subdivide.hpp>
#include <freiform/core/tuples.hpp>
#include <freiform/spline/patch.hpp>

#include <cmath>

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

template <std::size_t N, class P>
struct Extended {
    Patch<N, P> patch;
    // No point of the patch is farther from the exact continuation, at the same parameters of the new domain;
    // rounding of the coefficients included.
    double bound = 0;
};

namespace detail {
// How far a patch may be from the exact one, whose coefficients it has up to `errors`, coordinate by
// coordinate. Infinite where the weights may be 0.
double distance_of_errors(const Tuples& net, const Tuples& errors);
}  // namespace detail

// The same map on a larger domain, the end pieces continued. Refuses what extend_to of a basis refuses,
// rational patches with weights that would not be positive (they have a pole near there), and
// (ill_conditioned) weights that cannot be told from 0.
template <std::size_t N, class P>
Result<Extended<N, P>> extend_to(const Patch<N, P>& s, int axis, Interval on) {
    auto change = extend_to(s.basis(axis), on);
    if (!change) return std::unexpected(change.error());
    // A new coefficient is a sum of products, each with the error of its entry, its own rounding, and that of
    // the at most `width` sums that it runs through; underflow apart.
    BandMap error = change->map;
    for (std::size_t i = 0; i < error.entry.size(); ++i)
        error.entry[i] =
            1.01 * (change->entry_bound[i] + (error.width + 1) * 0x1p-53 * std::abs(error.entry[i]));
    Net<N, P> size = s.net();
    for (double& x : numbers(size.flat())) x = std::abs(x);
    Net<N, P> errors = along(axis, error, size);
    for (double& x : numbers(errors.flat())) x = 1.01 * x + error.width * 0x1p-1073;
    auto bases = s.bases();
    bases[std::size_t(axis)] = std::move(change->basis);
    auto patch = Patch<N, P>::make(std::move(bases), along(axis, change->map, s.net()));
    if (!patch) return std::unexpected(patch.error());
    const double bound = detail::distance_of_errors(tuples(std::span<const P>(patch->net().flat())),
                                                    tuples(std::span<const P>(errors.flat())));
    if (!std::isfinite(bound))
        return refuse(
            RefusalKind::ill_conditioned, "interval",
            text("[", on.lo, ", ", on.hi, "] is too far away: rounding hides where the curve runs"));
    return Extended<N, P>{std::move(*patch), bound};
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
