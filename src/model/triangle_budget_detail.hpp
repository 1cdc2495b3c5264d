// Hopeless demands are told before they take time.
#pragma once
#include <freiform/model/tessellate.hpp>

#include <span>
#include <vector>

namespace freiform {

// An estimate above a limit by more than this factor is believed.
inline constexpr double kFarBeyond = 4;

// Of points on the parameter curves of the face.
Box<2> sampled_box(const Model& model, const Face& face);

// About how many chords the curve needs within the tolerance, from its curvature at samples; a line none. An
// estimate.
double estimated_chords(const CurveGeometry<3>& curve, Interval on, double tolerance);

// About how many triangles each face needs, from few samples. An estimate.
std::vector<double> face_sizes(const Model& model, const TessellateOptions& options);

// Refuses (limit) what is beyond max_triangles by far; what is near it is counted while it is made. `sizes`:
// of the faces.
Result<void> check_budget(const Model& model, const TessellateOptions& options,
                          std::span<const double> sizes);

}  // namespace freiform
