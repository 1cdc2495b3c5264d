// Pictures of meshes, drawn without a window: on the graphics card where there is one, else by the processor.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/core/result.hpp>
#include <freiform/core/view.hpp>
#include <freiform/mesh/triangle_mesh.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace freiform {

// Rows from the top, three sRGB bytes per pixel.
struct Image {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;

    const unsigned char* pixel(int x, int y) const {
        return &rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
    }
};

struct RenderOptions {
    int width = 1200, height = 900;  // pixels, at most 16384
    View view{};
    bool perspective = false;  // mild; else parallel
    bool outlines = true;      // boundaries between parts, open edges
    bool edges = false;        // all edges of triangles
    bool zebra = false;        // reflected stripes, which show breaks of tangent and curvature
    int supersampling = 2;     // 1 to 4 per direction, on top of what the hardware smooths by itself
    double margin = 0.04;      // of the smaller side of the picture, in [0, 0.4]
    Colour colour{0.60, 0.67, 0.76, 1};                                // of parts without a colour
    Colour top{0.985, 0.988, 0.992, 1}, bottom{0.90, 0.915, 0.93, 1};  // background
};

// The mesh, shaded on both sides and fitted into the picture; normals are smooth where the vertices have
// them. Position and size of the model play no part. Opacity is ignored. Refuses with kind unavailable where
// no OpenGL 3.3 can be had (the message names what to install), with kind limit where the picture is too
// large.
Result<Image> render(const TriangleMesh& mesh, const RenderOptions& options = {});

Result<std::string> to_png(const Image& image);

}  // namespace freiform
