// The lengths of the edges of a model.
#pragma once
#include <freiform/model/model.hpp>
#include <freiform/query/length.hpp>

namespace freiform {

// Of the curve of every edge in space over its range, in order; of an edge that has none, of the surface of
// its first coedge along the parameter curve; 0 of degenerate edges. `accuracy` >= 0 is what each may be off,
// 0: as little as rounding allows (edges without a curve: 2^-20 of their length, and less where that is
// cheap). The bounds say what was reached; infinite: the surface is torn, or has no bounds of its
// derivatives, along the edge. Refuses a negative accuracy, and edges longer than doubles are.
//   const auto all = edge_lengths(model, 1e-6);   // (*all)[e].value, .bound
Result<std::vector<Measure>> edge_lengths(const Model& model, double accuracy);

}  // namespace freiform
