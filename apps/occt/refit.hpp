// Better parameter curves than those that come with a file, or that the reader has made for want of them.
#pragma once
#include <freiform/model/model.hpp>

#include <optional>

namespace freiform::occt {

// A spline whose image on the surface follows `c` over `on` with the same parameter, as near as the surface
// comes to `c`, plus `accuracy`. `guess` is a parameter curve near it. Empty where that does not succeed: at
// poles, where the guess is far off, and where too many pieces would be needed.
std::optional<CurveGeometry<2>> refit(const SurfaceGeometry& s, const CurveGeometry<3>& c,
                                      const CurveGeometry<2>& guess, Interval on, double accuracy);

// The largest distance, among samples, of the image of a parameter curve from its edge; of a degenerate edge
// from its `vertex`. No bound: says where one is wanted.
double sampled_gap(const SurfaceGeometry& s, const Edge& e, const Vec<3>& vertex,
                   const CurveGeometry<2>& on_surface);

}  // namespace freiform::occt
