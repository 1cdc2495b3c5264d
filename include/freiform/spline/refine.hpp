// The opposite of refinement: fewer knots, or a lower degree, within a proven distance.
#pragma once
#include <freiform/spline/patch.hpp>

namespace freiform {

template <std::size_t N, class P>
struct Reduced {
    Patch<N, P> patch;
    double bound =
        0;  // no point of the result is farther than this from the given patch at the same parameters
    int removed = 0;  // knots, counted with multiplicity; or degrees
};

// Removes knots of the basis along `axis`, those that matter least first, as long as the proven distance to
// the given patch stays <= tolerance (a distance in model units; rounding included, so that a tolerance of a
// few hundred roundings of the largest coordinate or less removes nothing). Undoes an insertion of knots.
// Knots at the ends and outside the domain stay; of the seam of a closed basis one knot stays. The ends of
// clamped patches stay to the bit, and so does the domain. Greedy: no smaller set of knots is claimed to be
// impossible.
//   auto thin = remove_knots(curve, 0, 1e-6);
template <std::size_t N, class P>
Result<Reduced<N, P>> remove_knots(const Patch<N, P>& patch, int axis, double tolerance);

// The degree along `axis` less one, within `tolerance`. Undoes an elevation: knots lose one multiplicity
// each, but stay. Refuses with no_answer, and the distance that was reached, where the tolerance does not
// allow it; unsupported for open bases that are not clamped (restrict them to their domain first).
template <std::size_t N, class P>
Result<Reduced<N, P>> reduce_degree(const Patch<N, P>& patch, int axis, double tolerance);

}  // namespace freiform
