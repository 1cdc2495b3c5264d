// draw: shaded pictures of surfaces, models and meshes.
#pragma once
#include "command.hpp"

#include <freiform/core/interval.hpp>
#include <freiform/core/view.hpp>
#include <freiform/mesh/triangle_mesh.hpp>

namespace freiform::cli {

struct ShadedOptions {
    std::string colour;         // gauss, mean, greatest, least, error, normal; empty: as the file says
    std::vector<double> range;  // of the colours; empty: found
    std::optional<double> tolerance;
    std::optional<int> width, height, isolines, normals;
    bool gpu = false;  // surfaces are drawn by shaders, without a mesh, where that can be
    bool control = false, edges = false, zebra = false, isophotes = false, perspective = false;
    View view{};
};

struct ShadedPicture {
    std::string png, report;  // report: what --json says
};

// Refuses where the program was built without OpenGL.
Result<ShadedPicture> shaded(const TriangleMesh& mesh, const ShadedOptions& options);
Result<ShadedPicture> shaded(const Document& document, std::span<const std::size_t> objects,
                             const Limits& limits, const ShadedOptions& options);

// The mesh with a colour for each vertex, from one number each: light at range.lo, dark at range.hi.
struct VertexNumbers {
    std::span<const double> values;
    Interval range;
    std::string title;
    std::vector<std::string> remarks;
};
Result<std::string> coloured(const TriangleMesh& mesh, const VertexNumbers& numbers,
                             const ShadedOptions& options);

}  // namespace freiform::cli
