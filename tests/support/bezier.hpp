// Curves of one piece, for tests.
#pragma once
#include "random.hpp"

#include <freiform/spline/patch.hpp>

namespace freiform::test {

// One Bezier piece.
template <class P>
Curve<P> bezier(std::vector<P> coefficients, Interval on = {0, 1}) {
    const int n = int(coefficients.size());
    return must(
        Curve<P>::make({must(BSplineBasis::bezier(n - 1, on))}, Net<1, P>({n}, std::move(coefficients))));
}
template <class P>
Curve<P> random_bezier(Random& random, int degree, Interval on = {0, 1}) {
    std::vector<P> b;
    for (int i = 0; i <= degree; ++i) b.push_back(random_coefficient<P>(random, 1, 0, 0.5));
    return bezier(std::move(b), on);
}

}  // namespace freiform::test
