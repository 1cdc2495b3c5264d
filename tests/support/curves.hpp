// Random curves and points through which curves are to pass.
#pragma once
#include "random.hpp"

namespace freiform::test {

// Clamped on [0, 1], with these inner knots.
template <class P>
Curve<P> random_curve(Random& random, int degree, std::vector<double> inner = {}) {
    std::vector<double> t(std::size_t(degree) + 1, 0.0);
    t.insert(t.end(), inner.begin(), inner.end());
    t.insert(t.end(), std::size_t(degree) + 1, 1.0);
    return random_patch_on<1, P>(random, {must(BSplineBasis::make(degree, t))});
}

// In a box of half-width 1 around `offset`.
template <int D>
std::vector<Vec<D>> random_points(Random& random, std::size_t count, double offset = 0) {
    std::vector<Vec<D>> q(count);
    for (auto& p : q) p = random_coefficient<Vec<D>>(random, 1, offset);
    return q;
}

}  // namespace freiform::test
