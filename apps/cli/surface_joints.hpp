// Joints of surfaces, as `continuity` reports them.
#pragma once
#include <freiform/io/json.hpp>
#include <freiform/query/surface_continuity.hpp>
#include <freiform/shape.hpp>

#include <string>
#include <vector>

namespace freiform::cli {

// The surfaces of a document, and where they meet.
struct SurfaceNeighbours {
    std::vector<std::size_t> object;  // of each surface that joints are counted by
    std::vector<SurfaceEdges> edges;
    std::vector<SurfaceJoint> joints;

    void add(const Shape& shape, std::size_t index, const ContinuityOptions& options);
    Result<void> find(double gap, const ContinuityOptions& options);
};

// The objects of the array "joints" of the answer.
void write_joints(json::Writer& w, const Document& document, const SurfaceNeighbours& all);
// Cells: place, order of C, order of G, first jump of C, first jump of G, remark.
std::vector<std::vector<std::string>> joint_rows(const Document& document, const SurfaceNeighbours& all);

}  // namespace freiform::cli
