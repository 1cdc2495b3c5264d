// Idea. Everything is drawn at `supersampling` times the size with the hardware's multisampling, then
// averaged. Surfaces are pushed back a little in depth, by their slope, so that lines on them are seen whole.
//
// Why not GL_LINES: a core profile promises a width of one pixel only.
#include "gpu/context.hpp"
#include "gpu/scene.hpp"
#include "gpu/shaders.hpp"

#include <freiform/gpu/render.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <epoxy/gl.h>
#include <numbers>

namespace freiform {
namespace {

constexpr int kMostPixels = 16384;  // per side

Result<void> check(const RenderOptions& o) {
    if (o.width < 1 || o.height < 1)
        return refuse(RefusalKind::invalid, "size",
                      text("a picture of ", o.width, " x ", o.height, " pixels"));
    if (o.width > kMostPixels || o.height > kMostPixels)
        return refuse(
            RefusalKind::limit, "size",
            text("a picture of ", o.width, " x ", o.height, " pixels; at most ", kMostPixels, " per side"));
    if (o.supersampling < 1 || o.supersampling > 4)
        return refuse(RefusalKind::invalid, "supersampling", text(o.supersampling, ", expected 1 to 4"));
    if (!(o.margin >= 0 && o.margin <= 0.4))
        return refuse(RefusalKind::invalid, "margin", text(o.margin, ", expected 0 to 0.4"));
    if (!(o.room >= 0 && o.room <= 0.5 * o.width))
        return refuse(RefusalKind::invalid, "room", text(o.room, ", expected 0 to half the width"));
    if (!(std::isfinite(o.range.lo) && std::isfinite(o.range.hi) && o.range.lo <= o.range.hi))
        return refuse(RefusalKind::invalid, "range", text("[", o.range.lo, ", ", o.range.hi, "]"));
    for (const RenderLines& lines : o.lines)
        for (const auto& [from, to] : lines.segments)
            if (!is_finite(from) || !is_finite(to))
                return refuse(RefusalKind::nonfinite, "lines", "a coordinate is not a finite number");
    if (!std::isfinite(o.view.azimuth) || !std::isfinite(o.view.elevation))
        return refuse(RefusalKind::nonfinite, "view", "an angle is not a finite number");
    for (const Colour& c : {o.colour, o.top, o.bottom})
        for (double x : {c.r, c.g, c.b})
            if (!(x >= 0 && x <= 1))
                return refuse(RefusalKind::invalid, "colour", text(x, " is outside [0, 1]"));
    return {};
}

Result<GLuint> compile(const char* vertex, const char* fragment) {
    const GLuint program = glCreateProgram();
    for (const auto& [type, source] :
         {std::pair(GL_VERTEX_SHADER, vertex), std::pair(GL_FRAGMENT_SHADER, fragment)}) {
        const GLuint shader = glCreateShader(GLenum(type));
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
    }
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked) return program;
    std::array<char, 500> log{};
    glGetProgramInfoLog(program, log.size(), nullptr, log.data());
    return refuse(RefusalKind::unavailable, "OpenGL", text("the driver refuses a shader: ", log.data()));
}

GLint place(GLuint program, const char* name) { return glGetUniformLocation(program, name); }

void set_colour(GLuint program, const char* name, const Colour& c) {
    glUniform3f(place(program, name), float(c.r), float(c.g), float(c.b));
}

void set_camera(GLuint program, const GpuScene& scene) {
    glUniformMatrix3fv(place(program, "rotation"), 1, GL_FALSE, scene.rotation.data());
    glUniformMatrix4fv(place(program, "projection"), 1, GL_FALSE, scene.projection.data());
}

template <class T>
void fill_buffer(GLenum target, const std::vector<T>& data) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(target, buffer);
    glBufferData(target, GLsizeiptr(data.size() * sizeof(T)), data.data(), GL_STATIC_DRAW);
}

void new_vertex_array() {
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
}

void attribute(GLuint index, GLint size, GLenum type, GLsizei stride, std::size_t offset, GLuint divisor) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, type, type == GL_UNSIGNED_BYTE, stride,
                          reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(index, divisor);
}

Result<void> draw_background(const RenderOptions& options) {
    const auto program = compile(kBackgroundVertex, kBackgroundFragment);
    if (!program) return std::unexpected(program.error());
    glUseProgram(*program);
    set_colour(*program, "top", options.top);
    set_colour(*program, "bottom", options.bottom);
    new_vertex_array();
    glDisable(GL_DEPTH_TEST);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
    return {};
}

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

Result<void> draw_surface(const GpuScene& scene, const RenderOptions& options) {
    const auto program = compile(kSurfaceVertex, kSurfaceFragment);
    if (!program) return std::unexpected(program.error());
    glUseProgram(*program);
    set_camera(*program, scene);
    glUniform3f(place(*program, "sky"), scene.rotation[6], scene.rotation[7], scene.rotation[8]);
    glUniform1f(place(*program, "inverse_distance"), scene.inverse_distance);
    glUniform1i(place(*program, "zebra"), options.zebra);
    glUniform1i(place(*program, "isophotes"), options.isophotes);
    const bool mapped = options.painting == Painting::sequential || options.painting == Painting::diverging;
    glUniform1i(place(*program, "painting"), mapped ? 1 : options.painting == Painting::normals ? 2 : 0);
    set_colour(*program, "no_value", kNoValue);
    if (mapped) load_map(options.painting == Painting::diverging ? MapKind::diverging : MapKind::sequential);
    new_vertex_array();
    fill_buffer(GL_ARRAY_BUFFER, scene.vertices);
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, scene.indices);
    constexpr auto kStride = GLsizei(sizeof(SceneVertex));
    attribute(0, 3, GL_FLOAT, kStride, offsetof(SceneVertex, position), 0);
    attribute(1, 3, GL_FLOAT, kStride, offsetof(SceneVertex, normal), 0);
    attribute(2, 4, GL_UNSIGNED_BYTE, kStride, offsetof(SceneVertex, colour), 0);
    attribute(3, 2, GL_FLOAT, kStride, offsetof(SceneVertex, field), 0);
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

struct Pen {
    double width = 1;  // pixels of the picture
    std::array<float, 4> ink{};
    float nearer = 0;
    bool round_ends = false, behind = false;
};

Result<void> draw_lines(const GpuScene& scene, const std::vector<SceneLine>& lines, const Pen& pen,
                        const RenderOptions& options) {
    if (lines.empty()) return {};
    const auto program = compile(kLineVertex, kLineFragment);
    if (!program) return std::unexpected(program.error());
    const int s = options.supersampling;
    glUseProgram(*program);
    set_camera(*program, scene);
    glUniform2f(place(*program, "half_size"), float(options.width * s) / 2, float(options.height * s) / 2);
    glUniform1f(place(*program, "width"), float(pen.width * s));
    glUniform1f(place(*program, "nearer"), pen.nearer);
    glUniform4fv(place(*program, "ink"), 1, pen.ink.data());
    glUniform1i(place(*program, "round_ends"), pen.round_ends);
    glDepthFunc(pen.behind ? GL_GREATER : GL_LESS);
    new_vertex_array();
    fill_buffer(GL_ARRAY_BUFFER, lines);
    attribute(0, 3, GL_FLOAT, sizeof(SceneLine), offsetof(SceneLine, from), 1);
    attribute(1, 3, GL_FLOAT, sizeof(SceneLine), offsetof(SceneLine, to), 1);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(lines.size()));
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
    return {};
}

// A framebuffer of one colour and, if it is drawn to, one depth buffer;
// 0 if there is not enough memory.
GLuint make_framebuffer(int width, int height, int samples, bool depth) {
    GLuint framebuffer = 0;
    std::array<GLuint, 2> buffers{};
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenRenderbuffers(2, buffers.data());
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    if (depth) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    }
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE ? framebuffer : 0;
}

Image averaged(const std::vector<unsigned char>& rgba, const RenderOptions& o) {
    const auto s = std::size_t(o.supersampling), width = std::size_t(o.width), height = std::size_t(o.height);
    Image image{o.width, o.height, std::vector<unsigned char>(3 * width * height)};
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                std::size_t sum = 0;
                for (std::size_t j = 0; j < s; ++j)
                    for (std::size_t i = 0; i < s; ++i)
                        sum += rgba[4 * (((height - 1 - y) * s + j) * width * s + x * s + i) + c];
                image.rgb[3 * (y * width + x) + c] = static_cast<unsigned char>((sum + s * s / 2) / (s * s));
            }
    return image;
}

Result<void> draw(const GpuScene& scene, const RenderOptions& options) {
    glClear(GL_DEPTH_BUFFER_BIT);
    if (auto r = draw_background(options); !r) return r;
    if (auto r = draw_surface(scene, options); !r) return r;
    if (auto r = draw_lines(scene, scene.edges, {0.9, {0.05f, 0.07f, 0.10f, 0.65f}, 2e-4f}, options); !r)
        return r;
    if (auto r = draw_lines(scene, scene.outlines, {1.4, {0.05f, 0.06f, 0.08f, 1}, 4e-4f}, options); !r)
        return r;
    for (const bool behind : {true, false})
        for (std::size_t i = 0; i < scene.lines.size(); ++i) {
            const RenderLines& l = options.lines[i];
            if (behind && l.behind <= 0) continue;
            const Pen pen{
                l.width,
                {float(l.colour.r), float(l.colour.g), float(l.colour.b), float(behind ? l.behind : 1)},
                6e-4f,
                true,
                behind};
            if (auto r = draw_lines(scene, scene.lines[i], pen, options); !r) return r;
        }
    return {};
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

    const int width = options.width * options.supersampling, height = options.height * options.supersampling;
    GLint most_pixels = 0, most_samples = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most_pixels);
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    if (width > most_pixels || height > most_pixels)
        return refuse(RefusalKind::limit, "size",
                      text("needs ", std::max(width, height),
                           " pixels per side with supersampling, the driver has ", most_pixels));
    const GLuint plain = make_framebuffer(width, height, 0, false);
    const GLuint sampled = make_framebuffer(width, height, std::min(most_samples, 4), true);
    if (plain == 0 || sampled == 0)
        return refuse(RefusalKind::limit, "size",
                      text("no memory for a picture of ", width, " x ", height, " pixels"));
    glViewport(0, 0, width, height);
    if (auto r = draw(scene, options); !r) return std::unexpected(r.error());

    // Resolve the samples, then read.
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, plain);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, plain);
    std::vector<unsigned char> rgba(4 * std::size_t(width) * std::size_t(height));
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        return refuse(error == GL_OUT_OF_MEMORY ? RefusalKind::limit : RefusalKind::unavailable, "OpenGL",
                      text("the driver reports error ", error));
    return averaged(rgba, options);
}

}  // namespace freiform
