// Surfaces for graphics cards: rational Bezier pieces and trimming loops as buffers, and the shaders that
// turn them into triangles. Nothing is tessellated beforehand: docs/gpu.md has the layout.
#pragma once
#include <freiform/gpu/render.hpp>
#include <freiform/model/model.hpp>
#include <freiform/spline/simplex.hpp>

#include <array>
#include <cstdint>
#include <memory>

namespace freiform {

// A segment of an edge, where it lies on one of its faces and where it lies itself: mostly the same.
struct SeamSegment {
    std::array<float, 3> from{}, to{}, edge_from{}, edge_to{};  // in the scene
    // Of the face, outward, and of another one that meets it there (without one, the same); zero: none.
    std::array<float, 3> normal_from{}, normal_to{}, other_from{}, other_to{};
    // Of the faces; the fourth byte is 255 where the normals are known to point out of what the faces
    // enclose, 1 where into it, else 128.
    std::array<std::uint8_t, 4> colour{}, other_colour{};
};
struct OutlineSegment {
    std::array<float, 3> from{}, to{};
};

// In coordinates of the scene, (p - middle) / size, which are in [-1, 1].
struct SurfaceBuffers {
    Vec<3> middle{};
    double size = 0;
    std::vector<std::array<float, 4>> texels;  // coefficients, curves of loops, records of pieces and faces
    int pieces = 0, faces = 0;                 // where their records begin
    int tensor_pieces = 0, triangles = 0;      // the tensor product pieces come first
    int face_count = 0;
    double edge_tolerance = 0;                // as asked for, in the scene
    std::vector<std::array<float, 2>> bends;  // of each piece: levels are the roots of it times `density`
    std::vector<SeamSegment> seams;           // along all edges, once for each face
    std::vector<OutlineSegment> outlines;     // edges between faces, and open ones
    std::vector<Vec<3>> extent;               // points of the surfaces, for fitting a view; model units
};

// A triangular patch beside the faces of a model.
struct TriangularFace {
    SimplexPatch<2, Hom<3>> patch;
    std::optional<Colour> colour;
};

struct SurfaceBufferOptions {
    double edge_tolerance = 0;           // of seams and outlines: distance in model units, > 0
    Colour colour{0.60, 0.67, 0.76, 1};  // of faces without one
};

// Refuses (unsupported) models with what has no rational pieces, (limit) more than 2^24 texels, and
// tolerances that are not positive; the place names the face.
Result<SurfaceBuffers> surface_buffers(const Model& model, std::span<const TriangularFace> triangles,
                                       const SurfaceBufferOptions& options);
inline Result<SurfaceBuffers> surface_buffers(const Model& model, const SurfaceBufferOptions& options) {
    return surface_buffers(model, {}, options);
}

// The sources, complete with their version line; `grid` needs no tessellation stage.
enum class GlslDialect { gl430, gles300 };
enum class SurfaceShader {
    patch_vertex,
    patch_control,
    patch_evaluation,
    triangle_evaluation,
    grid_vertex,
    surface_fragment,
    seam_vertex,
    seam_fragment,
    evaluate_float,
    evaluate_double
};
std::string shader_source(SurfaceShader shader, GlslDialect dialect = GlslDialect::gl430);

// tessellation: OpenGL 4.3; grid: OpenGL ES 3.0, which is WebGL 2.
enum class SurfacePipeline { tessellation, grid };

// What the vertices of the triangles are, for whoever checks or exports them.
struct SurfaceVertex {
    std::array<float, 3> position{}, normal{};  // in the scene
    std::array<float, 2> at{};                  // place in its piece
    int piece = 0;
};

// Draws the same surfaces from many views. Uses OpenGL in the thread that calls, and leaves there the context
// that was current.
class SurfaceRenderer {
public:
    static Result<SurfaceRenderer> make(SurfaceBuffers buffers,
                                        SurfacePipeline pipeline = SurfacePipeline::tessellation);
    SurfaceRenderer(SurfaceRenderer&&) noexcept;
    SurfaceRenderer& operator=(SurfaceRenderer&&) noexcept;
    ~SurfaceRenderer();

    // As render() of a mesh that is within `deviation` pixels of the picture, > 0, of the surfaces; fields
    // and edges of triangles are refused.
    Result<Image> draw(const RenderOptions& options, double deviation = 0.2);
    // The triangles of that picture, three vertices each. REQUIRES SurfacePipeline::tessellation.
    Result<std::vector<SurfaceVertex>> triangles(const RenderOptions& options, double deviation = 0.2);

private:
    struct State;
    explicit SurfaceRenderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// Of many parameters by a compute shader, as PreparedPatch does it on the processor: `at` in the domain,
// which is not checked; `normals` empty or as many. REQUIRES points.size() == at.size(). Refuses
// (unavailable) where there is no OpenGL 4.3, or no double in shaders.
enum class ShaderPrecision { single, twice };
class SurfaceEvaluator {
public:
    static Result<SurfaceEvaluator> make(const Surface<Hom<3>>& surface, ShaderPrecision precision);
    SurfaceEvaluator(SurfaceEvaluator&&) noexcept;
    SurfaceEvaluator& operator=(SurfaceEvaluator&&) noexcept;
    ~SurfaceEvaluator();
    Result<void> evaluate(std::span<const Param<2>> at, std::span<Vec<3>> points, std::span<Vec<3>> normals);

private:
    struct State;
    explicit SurfaceEvaluator(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace freiform
