// Models in other units, exactly.
#pragma once
#include <freiform/model/model.hpp>

namespace freiform {

// All coordinates, distances and tolerances times 2^exponent; parameters stay what they are. Exact, but for
// numbers that become smaller than 2^-1022, which move by less than 2^-1074. Refuses (nonfinite) what would
// become infinite.
Result<Model> rescaled(const Model& model, int exponent);
// Likewise divided by a positive number: each is rounded. Refuses (invalid) other numbers.
Result<Model> divided(const Model& model, double by);

}  // namespace freiform
