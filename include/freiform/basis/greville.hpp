// Where coefficients belong.
#pragma once
#include <freiform/basis/bspline.hpp>

namespace freiform {

// The mean of the `degree` knots after knot i, degree >= 1: the coefficient i of u itself, written in the
// basis [Farin 2002, 8.6]. Of a closed basis this may lie beyond the domain.
inline double greville(const BSplineBasis& basis, int i) {
    double sum = 0;
    for (int k = 1; k <= basis.degree(); ++k) sum += basis.knot(i + k) / basis.degree();
    return sum;
}

}  // namespace freiform
