// Polynomials of several parameters in Bernstein form on the unit box, of degree 2 p_d along axis d.
#pragma once
#include "query/nearest_foot_detail.hpp"

#include <optional>

namespace freiform::detail {

struct NearestForm {
    using Parameters = NearestTree::Parameters;

    int params = 1;
    std::array<int, kMostParams> degree{};  // p_d; 0: does not depend on parameter d
    int count = 1;                          // of coefficients
    const double* f = nullptr;              // F, the last parameter fastest

    struct Extreme {
        double value;
        std::size_t at;
    };
    Extreme least() const;
    Extreme most() const;
    // The parameters (Greville abscissae) of coefficient i, in a block over [lo, hi].
    Parameters place(std::size_t i, const Parameters& lo, const Parameters& hi) const;
    // The least and the largest first difference along the axis.
    Interval slope(int axis) const;
    // Is F certainly convex? `eps` bounds the error of its coefficients.
    bool convex(double eps) const;
    // Is F certainly strictly concave along the axis?
    bool concave_along(int axis, double eps) const;
    // Has the Hessian of every average of F and G certainly a negative eigenvalue in the plane of the axes d
    // and e, everywhere?
    bool is_saddle(const NearestForm& g, int d, int e, double eps) const;
    // A lower bound of a convex F by its tangent at x.
    double below_tangent(const Parameters& x, double eps) const;
    // The corner with the least F, each parameter 0 or 1, if F is certainly negative there.
    std::optional<Parameters> inner_corner(double eps) const;
};

}  // namespace freiform::detail
