// Complete sources from the files of src/gpu/glsl.
#include "gpu/gl_tools_detail.hpp"
#include "gpu/glsl_sources.hpp"

namespace freiform {

namespace {

constexpr std::string_view kFloats =
    "#define Real float\n#define Real2 vec2\n#define Real3 vec3\n#define Real4 vec4\n";
constexpr std::string_view kDoubles =
    "#define DOUBLE\n#define Real double\n#define Real2 dvec2\n#define Real3 dvec3\n#define Real4 dvec4\n";

// The coefficients come after their use, so they are announced.
constexpr std::string_view kAnnounced = "Real4 coefficient(int i);\n";

}  // namespace

std::string shader_source(SurfaceShader shader, GlslDialect dialect) {
    const std::string version = version_line(dialect);
    const std::string pieces =
        text(kFloats, glsl(dialect == GlslDialect::gl430 ? "data_buffer.glsl" : "data_texture.glsl"),
             kAnnounced, glsl("bezier.glsl"), glsl("pieces.glsl"));
    switch (shader) {
        case SurfaceShader::patch_vertex:
            return text(version, glsl("patch.vert"));
        case SurfaceShader::patch_control:
            return text(version, pieces, glsl("patch.tesc"));
        case SurfaceShader::patch_evaluation:
            return text(version, pieces, glsl("patch.tese"));
        case SurfaceShader::triangle_evaluation:
            return text(version, "#define TRIANGLES\n", pieces, glsl("patch.tese"));
        case SurfaceShader::grid_vertex:
            return text(version, pieces, glsl("grid.vert"));
        case SurfaceShader::surface_fragment:
            return text(version, dialect == GlslDialect::gl430 ? "#define SAMPLES\n" : "", pieces,
                        glsl("trim.glsl"), glsl("shading.glsl"), glsl("surface.frag"));
        case SurfaceShader::seam_vertex:
            return text(version, glsl("seam.vert"));
        case SurfaceShader::seam_fragment:
            return text(version, glsl("shading.glsl"), glsl("seam.frag"));
        case SurfaceShader::evaluate_float:
            return text(version, kFloats, kAnnounced, glsl("bezier.glsl"), glsl("evaluate.comp"));
        case SurfaceShader::evaluate_double:
            return text(version, kDoubles, kAnnounced, glsl("bezier.glsl"), glsl("evaluate.comp"));
    }
    return {};
}

}  // namespace freiform
