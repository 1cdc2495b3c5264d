// Coefficients with errors: how far that moves a patch.
//
// Polynomials: by the hull property, at most the largest error of a coefficient. Rational ones, with the
// exact function g, the computed one f = N / W, and the errors e_N, e_W of numerator and weight: f - g = (e_N
// - g e_W) / W, |g| <= G + d with G = max |f| over the hull and d = max |f - g|. With a = max |e_N| / w and b
// = max e_W / w over the coefficients, d <= a + (G + d) b, so d <= (a + G b) / (1 - b).
#include <freiform/spline/subdivision.hpp>

#include <algorithm>
#include <limits>

namespace freiform::detail {

double distance_of_errors(const Tuples& net, const Tuples& errors) {
    double a = 0, b = 0, far = 0;
    for (std::size_t i = 0; i < net.count(); ++i) {
        const double w = net.weight(i);
        a = std::max(a, norm(errors.numerator(i)) / w);
        far = std::max(far, norm(net.point(i)));
        if (net.rational) b = std::max(b, errors.weight(i) / w);
    }
    if (!(b < 0.5)) return std::numeric_limits<double>::infinity();
    return (a + far * b) / (1 - b) * (1 + 0x1p-45);
}

}  // namespace freiform::detail
