// Pictures of meshes, drawn without a window: on the graphics card where there is one, else by the processor.
#pragma once
#include <freiform/colour/colour_map.hpp>
#include <freiform/core/image.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>
#include <freiform/core/view.hpp>
#include <freiform/mesh/triangle_mesh.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freiform {

// What the colours of the surface say: nothing (those of the parts), a field, or the direction of the normal
// with x, y, z as red, green, blue.
enum class Painting { parts, sequential, diverging, normals };

// Segments in space, drawn over the surface where they are not behind it; of length 0: round dots.
struct RenderLines {
    std::vector<std::array<Vec<3>, 2>> segments;
    Colour colour{0.05, 0.06, 0.08, 1};
    double width = 1;   // pixels
    double behind = 0;  // opacity of what is behind the surface
};

struct RenderOptions {
    int width = 1200, height = 900;  // pixels, at most 16384
    View view{};
    bool perspective = false;  // mild; else parallel
    bool outlines = true;      // boundaries between parts, open edges
    bool edges = false;        // all edges of triangles
    bool zebra = false;        // reflected stripes, which show breaks of tangent and curvature
    bool isophotes = false;    // lines along which n makes an angle of 10, 20, .. degrees with the light
    Painting painting = Painting::parts;
    std::span<const double> field{};  // one number for each vertex of the mesh; NaN: kNoValue
    Interval range{0, 1};             // what the map runs over; diverging: 0 has the middle colour
    std::span<const RenderLines> lines{};
    std::span<const Vec<3>> frame{};  // what the picture is fitted to instead of all that is drawn
    double room = 0;                  // pixels at the right that the model leaves free
    int supersampling = 2;            // 1 to 4 per direction, on top of what the hardware smooths by itself
    double margin = 0.04;             // of the smaller side of the picture, in [0, 0.4]
    Colour colour{0.60, 0.67, 0.76, 1};                                // of parts without a colour
    Colour top{0.985, 0.988, 0.992, 1}, bottom{0.90, 0.915, 0.93, 1};  // background
};

// The mesh, shaded on both sides and fitted into the picture; normals are smooth where the vertices have
// them. Position and size of the model play no part. Opacity is ignored. Refuses with kind unavailable where
// no OpenGL 3.3 can be had (the message names what to install), with kind limit where the picture is too
// large.
Result<Image> render(const TriangleMesh& mesh, const RenderOptions& options = {});

// How long a pixel of that picture is, in the unit of the mesh, where the mesh would be nearest to the eye:
// what a mesh may be off unseen. 0 of a mesh without extent. Nothing is drawn.
double pixel_size(const TriangleMesh& mesh, const RenderOptions& options = {});

Result<std::string> to_png(const Image& image);

}  // namespace freiform
