// What pictures of meshes and of surfaces have in common: programs, buffers, lines, the canvas.
#pragma once
#include "gpu/scene.hpp"

#include <freiform/gpu/surfaces.hpp>

#include <epoxy/gl.h>
#include <map>
#include <string>
#include <vector>

namespace freiform {

Result<void> check(const RenderOptions& options);

struct ShaderPart {
    GLenum stage;
    std::string source;  // with its version line
};
// `captured`: outputs that transform feedback takes, interleaved.
Result<GLuint> link_program(const std::vector<ShaderPart>& parts,
                            const std::vector<const char*>& captured = {});

std::string version_line(GlslDialect dialect);
inline constexpr const char* kMeshVersion = "#version 330 core\n";

// Programs of a vertex and a fragment shader, compiled once; sources without their version line.
class GlPrograms {
public:
    explicit GlPrograms(std::string version) : version_(std::move(version)) {}
    Result<GLuint> of(std::string_view vertex, std::string_view fragment);

private:
    std::string version_;
    std::map<std::string, GLuint> programs_;
};

inline GLint place(GLuint program, const char* name) { return glGetUniformLocation(program, name); }
void set_colour(GLuint program, const char* name, const Colour& c);
void set_camera(GLuint program, const GpuScene& scene);
// What shading.glsl asks for; `painting`: its number.
void set_light(GLuint program, const GpuScene& scene, const RenderOptions& options, int painting);

// A vertex array with its buffers, until it is released.
struct VertexArray {
    GLuint array = 0;
    std::vector<GLuint> buffers;
    void begin();
    template <class T>
    void fill(GLenum target, const std::vector<T>& data) {
        fill_bytes(target, data.data(), data.size() * sizeof(T));
    }
    void fill_bytes(GLenum target, const void* data, std::size_t size);
    void attribute(GLuint index, GLint size, GLenum type, std::size_t stride, std::size_t offset,
                   GLuint divisor);
    void release();
};

Result<void> draw_background(GlPrograms& programs, const RenderOptions& options);

struct Pen {
    double width = 1;  // pixels of the picture
    std::array<float, 4> ink{};
    float nearer = 0;
    bool round_ends = false, behind = false;
};
Result<void> draw_lines(GlPrograms& programs, const GpuScene& scene, const std::vector<SceneLine>& lines,
                        const Pen& pen, const RenderOptions& options);
inline constexpr Pen kOutlinePen{1.4, {0.05f, 0.06f, 0.08f, 1}, 4e-4f};
// RenderOptions::lines, those behind the surface first.
Result<void> draw_user_lines(GlPrograms& programs, const GpuScene& scene, const RenderOptions& options);

// Framebuffers of one size.
class Canvas {
public:
    // Makes them, unless they are there, and binds the one to draw on; depth is cleared. `samples`: at most
    // so many for each of its pixels, the same in all calls; 0: their middles alone.
    Result<void> begin(const RenderOptions& options, int samples = 4);
    Result<Image> finish(const RenderOptions& options);

private:
    int width_ = 0, height_ = 0;
    std::array<GLuint, 2> framebuffers_{};  // plain, sampled
    std::vector<GLuint> renderbuffers_;
};

}  // namespace freiform
