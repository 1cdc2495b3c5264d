// Edges of a model as segments: essay in surface_seams.cpp.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/model/model.hpp>
#include <freiform/spline/simplex.hpp>

#include <vector>

namespace freiform {

struct EdgeSeam {
    int face = -1, other = -1;                          // another face at the edge; without one, the same
    std::vector<Vec<3>> points, edge, normals, others;  // on the face, on the edge, of the faces
    bool outline = false;                               // this one also stands for the edge as a line
};

// Along all edges, once for each of their coedges. Segments leave the curves by about `tolerance` at most: an
// estimate, from three points within each.
std::vector<EdgeSeam> seams_of(const Model& model, double tolerance);
// Along the sides of a triangle.
std::vector<EdgeSeam> seams_of(const SimplexPatch<2, Hom<3>>& triangle, int face, double tolerance);

}  // namespace freiform
