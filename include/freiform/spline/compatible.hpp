// Curves on one basis: what surfaces through several curves begin with.
#pragma once
#include <freiform/spline/patch.hpp>

#include <span>
#include <vector>

namespace freiform {

template <class P>
struct Compatible {
    std::vector<Curve<P>> curves;
    // Every coordinate (of rational curves: every numerator and every weight) of a coefficient of curve i is
    // off by at most relative[i] times the largest such number of curve i. 0: unchanged to the bit.
    std::vector<double> relative;
};

// The same curves with the basis of all: the highest degree, the domain of the first, the knots of all in
// their highest multiplicity. Closed if all are (and closed bases exist that agree), else clamped. Domains
// that differ are mapped linearly, which rounds inner knots. Refuses no curves, and degrees and knots that no
// basis has.
template <class P>
Result<Compatible<P>> compatible(std::span<const Curve<P>> curves);

}  // namespace freiform
