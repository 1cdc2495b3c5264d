// Idea. Surfaces are pushed back a little in depth, by their slope, so that lines on them are seen whole.
#include "gpu/context.hpp"
#include "gpu/gl_tools_detail.hpp"
#include "gpu/glsl_sources.hpp"
#include "gpu/shaders.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace freiform {
namespace {

// As the texture that the programs read.
void load_map(MapKind kind) {
    std::vector<unsigned char> texels;
    const ColourMap map(kind);
    for (const Colour& c : map.colours())
        for (const double x : {c.r, c.g, c.b})
            texels.push_back(static_cast<unsigned char>(std::lround(255 * x)));
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_1D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage1D(GL_TEXTURE_1D, 0, GL_RGB8, ColourMap::kSize, 0, GL_RGB, GL_UNSIGNED_BYTE, texels.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_1D, filter, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
}

Result<void> draw_surface(GlPrograms& programs, const GpuScene& scene, const RenderOptions& options) {
    const auto program = programs.of(kSurfaceVertex, text(glsl("shading.glsl"), glsl("mesh.frag")));
    if (!program) return std::unexpected(program.error());
    glUseProgram(*program);
    set_camera(*program, scene);
    const bool mapped = options.painting == Painting::sequential || options.painting == Painting::diverging;
    set_light(*program, scene, options, mapped ? 1 : options.painting == Painting::normals ? 2 : 0);
    set_colour(*program, "no_value", kNoValue);
    if (mapped) load_map(options.painting == Painting::diverging ? MapKind::diverging : MapKind::sequential);
    VertexArray array;
    array.begin();
    array.fill(GL_ARRAY_BUFFER, scene.vertices);
    array.fill(GL_ELEMENT_ARRAY_BUFFER, scene.indices);
    constexpr std::size_t kStride = sizeof(SceneVertex);
    array.attribute(0, 3, GL_FLOAT, kStride, offsetof(SceneVertex, position), 0);
    array.attribute(1, 3, GL_FLOAT, kStride, offsetof(SceneVertex, normal), 0);
    array.attribute(2, 4, GL_UNSIGNED_BYTE, kStride, offsetof(SceneVertex, colour), 0);
    array.attribute(3, 2, GL_FLOAT, kStride, offsetof(SceneVertex, field), 0);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(float(options.supersampling), 1);
    // In pieces: a count of indices is a GLsizei.
    constexpr std::size_t kPiece = 3'000'000;
    for (std::size_t i = 0; i < scene.indices.size(); i += kPiece)
        glDrawElements(GL_TRIANGLES, GLsizei(std::min(kPiece, scene.indices.size() - i)), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(i * sizeof(std::uint32_t)));
    glDisable(GL_POLYGON_OFFSET_FILL);
    return {};
}

Result<void> draw(const GpuScene& scene, const RenderOptions& options) {
    GlPrograms programs(kMeshVersion);
    if (auto r = draw_background(programs, options); !r) return r;
    if (auto r = draw_surface(programs, scene, options); !r) return r;
    if (auto r =
            draw_lines(programs, scene, scene.edges, {0.9, {0.05f, 0.07f, 0.10f, 0.65f}, 2e-4f}, options);
        !r)
        return r;
    if (auto r = draw_lines(programs, scene, scene.outlines, kOutlinePen, options); !r) return r;
    return draw_user_lines(programs, scene, options);
}

}  // namespace

Result<Image> render(const TriangleMesh& mesh, const RenderOptions& options) {
    if (auto r = validate(mesh); !r) return std::unexpected(r.error());
    if (auto r = check(options); !r) return std::unexpected(r.error());
    if (!options.field.empty() && options.field.size() != mesh.vertices.size())
        return refuse(RefusalKind::invalid, "field",
                      text(options.field.size(), " values for ", mesh.vertices.size(), " vertices"));
    const GpuScene scene = make_scene(mesh, options);
    const auto context = GlContext::make();
    if (!context) return std::unexpected(context.error());
    Canvas canvas;
    if (auto r = canvas.begin(options); !r) return std::unexpected(r.error());
    if (auto r = draw(scene, options); !r) return std::unexpected(r.error());
    return canvas.finish(options);
}

}  // namespace freiform
