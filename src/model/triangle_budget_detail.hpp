// Hopeless demands are told before they take time.
#pragma once
#include <freiform/model/tessellate.hpp>

namespace freiform {

// Refuses (limit) what is beyond max_triangles by far; what is near it is counted while it is made.
Result<void> check_budget(const Model& model, const TessellateOptions& options);

}  // namespace freiform
