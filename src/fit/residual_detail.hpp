// What all interpolation ends with: the residual that the bound is built on, and the condition of the system.
// The argument for the bound is in interpolate.cpp.
#pragma once
#include "band_system_detail.hpp"

#include <freiform/fit/interpolate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform::detail {

inline double chessboard_norm(const BandSystem& a) {
    std::vector<double> x(std::size_t(a.size()));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = i % 2 == 0 ? 1 : -1;
    a.solve(x.data(), 1);
    double most = 0;
    for (double v : x) most = std::max(most, std::abs(v));
    return most;
}

// The largest norm of a difference, without a square root for each.
template <int D>
struct LargestResidual {
    double norm_ = 0;
    void add(const Vec<D>& r) {
        if (!(D * max_abs(r) <= norm_)) norm_ = std::max(norm_, norm(r));
    }
};

template <std::size_t N, int D>
double with_rounding(double residual, const Patch<N, Vec<D>>& patch) {
    return (residual + std::sqrt(double(D)) * patch.value_error_bound()) *
           (1 + 16 * (std::numeric_limits<double>::epsilon() / 2));
}

template <std::size_t N, int D>
Result<Interpolant<N, D>> finished(std::array<BSplineBasis, N> bases, Net<N, Vec<D>> net, double condition) {
    auto patch = Patch<N, Vec<D>>::make(std::move(bases), std::move(net));
    if (!patch)
        return refuse(RefusalKind::ill_conditioned, "at",
                      "the spline through the points leaves the range of double");
    return Interpolant<N, D>{std::move(*patch), 0, condition};
}

}  // namespace freiform::detail
