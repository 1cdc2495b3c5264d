// How far a parameter curve of a face strays from the edge that it describes: a proven bound, not samples.
//
//     const EdgeGap gap = edge_gap(DerivativeQuery<2, 3>(face.surface), coedge.curve, *edge.curve,
//     edge.range, {});
#pragma once
#include <freiform/spline/derivative_bounds.hpp>

namespace freiform {

struct EdgeGapOptions {
    double target = 0;     // distance: a bound up to this is good enough
    double factor = 1.25;  // > 1: so is one up to this times the largest gap that was found
    int max_samples =
        40'000;  // effort: after that many places (a piece counts for some) the bound is what it is
    double roundings = 32;  // and one up to this times what a place may be off in rounding; 3 and no less are
                            // in every bound
};

struct EdgeGap {
    double found = 0;  // the largest gap at the places looked at
    // |surface(on_surface(t)) - in_space(t)| is nowhere in `range` above this, rounding included; infinite
    // where no bound exists: at tears, at singular points of an offset, outside the domain of one of the
    // curves.
    double bound = 0;
};

// The surface at the parameters moved into its domain, where a spline ends there, as everywhere in the
// library. A point is a line without direction: `Line<3>{point, {}}` measures a degenerate edge. REQUIRES
// finite range.
EdgeGap edge_gap(const DerivativeQuery<2, 3>& surface, const CurveGeometry<2>& on_surface,
                 const CurveGeometry<3>& in_space, Interval range, const EdgeGapOptions& options);

}  // namespace freiform
