// Boundaries in the parameters of a surface that run into themselves.
#pragma once
#include "step_loops.hpp"

#include <functional>

namespace freiform::step {

// Whether polygons through points of the loops touch themselves or each other elsewhere than in vertices,
// coarse ones and fine ones, moved into the surface where that ends, as meshes are. A guess: what is between
// the points is not seen.
bool is_tangled(const std::vector<std::vector<Use>>& loops, const Model& model, const Chart& chart);

// Edges on which a vertex of another loop of their face lies, nearer than `close`, are cut there, in all
// faces. `told`: is called for each, with the number of parts that it has now and the first of the new ones.
void cut_touched_edges(Model& model, double close, const std::function<void(int, int, int)>& told);

}  // namespace freiform::step
