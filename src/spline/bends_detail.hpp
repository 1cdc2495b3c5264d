// Where second derivatives of splines jump, and what evaluation rounds them by.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/patch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace freiform {

// The ends, and the breaks between at which fewer than two derivatives are continuous.
inline std::vector<double> bends_of(const BSplineBasis& basis, const std::vector<double>& breaks) {
    std::vector<double> out{breaks.front()};
    for (std::size_t i = 1; i + 1 < breaks.size(); ++i)
        if (basis.multiplicity(breaks[i]) + 2 > basis.degree()) out.push_back(breaks[i]);
    out.push_back(breaks.back());
    return out;
}

// Second derivatives, times the sides of the thinnest piece, are sums of products of coefficients (of size A,
// weights w) with factors up to 4 p^2, divided by weights up to three times: 2^12 u for all roundings.
template <std::size_t N, class P>
double second_rounding_of(const Patch<N, P>& patch) {
    double least = kInfinity, most = 0, size = 0;
    for (const P& p : patch.net().flat()) {
        const double w = Space<P>::weight(p);
        least = std::min(least, w), most = std::max(most, w);
        for (int i = 0; i < Space<P>::kDim; ++i) size = std::max(size, std::abs(p[i]) / w);
    }
    int degree = 1;
    for (std::size_t d = 0; d < N; ++d) degree = std::max(degree, patch.basis(int(d)).degree());
    return 0x1p-41 * (most / least) * (most / least) * size * (4.0 * degree * degree);
}

}  // namespace freiform
