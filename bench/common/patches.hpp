// The inputs of the comparison of evaluation as patches.
#pragma once
#include <freiform/spline/patch.hpp>

#include <evaluation_inputs.hpp>

namespace freiform::bench {

template <std::size_t N>
Net<N, Hom<3>> net_of(const Index<N>& extent, const std::vector<double>& points,
                      const std::vector<double>& weights) {
    std::vector<Hom<3>> c;
    for (std::size_t i = 0; i < weights.size(); ++i)
        c.push_back(weighted(Vec<3>{{points[3 * i], points[3 * i + 1], points[3 * i + 2]}}, weights[i]));
    return {extent, std::move(c)};
}
inline Surface<Hom<3>> patch_of(const SurfaceInput& s) {
    return *Surface<Hom<3>>::make(
        {*BSplineBasis::make(s.degree, s.knots_u), *BSplineBasis::make(s.degree, s.knots_v)},
        net_of<2>({s.size, s.size}, s.points, s.weights));
}
inline Curve<Hom<3>> patch_of(const CurveInput& c) {
    return *Curve<Hom<3>>::make({*BSplineBasis::make(3, c.knots)},
                                net_of<1>({CurveInput::kSize}, c.points, c.weights));
}

}  // namespace freiform::bench
