// A mesh as what faces are measured against: essay in mesh_side.cpp.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>
#include <freiform/mesh/triangle_tree.hpp>

#include <array>
#include <span>
#include <vector>

namespace freiform {

Vec<3> mean_of(std::span<const Vec<3>> points);

class MeshSide {
public:
    explicit MeshSide(const TriangleMesh& mesh);

    const TriangleTree& tree() const { return tree_; }
    const Box<3>& box() const { return box_; }

    // Of the distance to the mesh from every point that is within `error` of flat pieces with these corners;
    // `nearest`: to a point near their middle.
    double bound(std::span<const Vec<3>> corners, double error, const TriangleTree::Found& nearest) const;

private:
    double across(std::span<const Vec<3>> corners, double error, const TriangleTree::Found& nearest,
                  double scale) const;

    TriangleTree tree_;
    std::vector<std::array<int, 3>>
        neighbours_;  // across the side opposite to each corner; -1: none, or many
    Box<3> box_;
};

}  // namespace freiform
