// The parts of a picture.
//
// Idea. Everything is drawn at `supersampling` times the size with the hardware's multisampling, then
// averaged.
//
// Why not GL_LINES: a core profile promises a width of one pixel only.
#include "gpu/gl_tools_detail.hpp"
#include "gpu/shaders.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr int kMostPixels = 16384;  // per side

// A framebuffer of one colour and, if it is drawn to, one depth buffer;
// 0 if there is not enough memory.
GLuint make_framebuffer(int width, int height, int samples, bool depth, std::vector<GLuint>& renderbuffers) {
    GLuint framebuffer = 0;
    std::array<GLuint, 2> buffers{};
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenRenderbuffers(2, buffers.data());
    renderbuffers.insert(renderbuffers.end(), buffers.begin(), buffers.end());
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

}  // namespace

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

std::string version_line(GlslDialect dialect) {
    return dialect == GlslDialect::gl430 ? "#version 430 core\n"
                                         : "#version 300 es\nprecision highp float;\nprecision highp int;\n";
}

Result<GLuint> link_program(const std::vector<ShaderPart>& parts, const std::vector<const char*>& captured) {
    const GLuint program = glCreateProgram();
    std::array<char, 1000> log{};
    for (const ShaderPart& part : parts) {
        const GLuint shader = glCreateShader(part.stage);
        const char* const source = part.source.c_str();
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        GLint compiled = 0;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        if (!compiled) glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
        glAttachShader(program, shader);
        glDeleteShader(shader);
        if (!compiled) {
            glDeleteProgram(program);
            return refuse(RefusalKind::unavailable, "OpenGL",
                          text("the driver refuses a shader: ", log.data()));
        }
    }
    if (!captured.empty())
        glTransformFeedbackVaryings(program, GLsizei(captured.size()), captured.data(),
                                    GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked) return program;
    glGetProgramInfoLog(program, log.size(), nullptr, log.data());
    glDeleteProgram(program);
    return refuse(RefusalKind::unavailable, "OpenGL", text("the driver refuses a program: ", log.data()));
}

Result<GLuint> GlPrograms::of(std::string_view vertex, std::string_view fragment) {
    const std::string key = text(vertex, fragment);
    if (const auto found = programs_.find(key); found != programs_.end()) return found->second;
    auto program = link_program(
        {{GL_VERTEX_SHADER, text(version_, vertex)}, {GL_FRAGMENT_SHADER, text(version_, fragment)}});
    if (program) programs_[key] = *program;
    return program;
}

void set_colour(GLuint program, const char* name, const Colour& c) {
    glUniform3f(place(program, name), float(c.r), float(c.g), float(c.b));
}

void set_camera(GLuint program, const GpuScene& scene) {
    glUniformMatrix3fv(place(program, "rotation"), 1, GL_FALSE, scene.rotation.data());
    glUniformMatrix4fv(place(program, "projection"), 1, GL_FALSE, scene.projection.data());
}

void set_light(GLuint program, const GpuScene& scene, const RenderOptions& options, int painting) {
    glUniform3f(place(program, "sky"), scene.rotation[6], scene.rotation[7], scene.rotation[8]);
    glUniform1f(place(program, "inverse_distance"), scene.inverse_distance);
    glUniform1i(place(program, "zebra"), options.zebra);
    glUniform1i(place(program, "isophotes"), options.isophotes);
    glUniform1i(place(program, "painting"), painting);
}

void VertexArray::begin() {
    if (array == 0) glGenVertexArrays(1, &array);
    glBindVertexArray(array);
}

void VertexArray::fill_bytes(GLenum target, const void* data, std::size_t size) {
    buffers.push_back(0);
    glGenBuffers(1, &buffers.back());
    glBindBuffer(target, buffers.back());
    glBufferData(target, GLsizeiptr(size), data, GL_STATIC_DRAW);
}

void VertexArray::attribute(GLuint index, GLint size, GLenum type, std::size_t stride, std::size_t offset,
                            GLuint divisor) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, type, type == GL_UNSIGNED_BYTE, GLsizei(stride),
                          reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(index, divisor);
}

void VertexArray::release() {
    glDeleteVertexArrays(1, &array);
    glDeleteBuffers(GLsizei(buffers.size()), buffers.data());
    array = 0;
    buffers.clear();
}

Result<void> draw_background(GlPrograms& programs, const RenderOptions& options) {
    const auto program = programs.of(kBackgroundVertex, kBackgroundFragment);
    if (!program) return std::unexpected(program.error());
    glUseProgram(*program);
    set_colour(*program, "top", options.top);
    set_colour(*program, "bottom", options.bottom);
    VertexArray none;
    none.begin();
    glDisable(GL_DEPTH_TEST);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
    none.release();
    return {};
}

Result<void> draw_lines(GlPrograms& programs, const GpuScene& scene, const std::vector<SceneLine>& lines,
                        const Pen& pen, const RenderOptions& options) {
    if (lines.empty()) return {};
    const auto program = programs.of(kLineVertex, kLineFragment);
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
    VertexArray array;
    array.begin();
    array.fill(GL_ARRAY_BUFFER, lines);
    array.attribute(0, 3, GL_FLOAT, sizeof(SceneLine), offsetof(SceneLine, from), 1);
    array.attribute(1, 3, GL_FLOAT, sizeof(SceneLine), offsetof(SceneLine, to), 1);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(lines.size()));
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
    array.release();
    return {};
}

Result<void> draw_user_lines(GlPrograms& programs, const GpuScene& scene, const RenderOptions& options) {
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
            if (auto r = draw_lines(programs, scene, scene.lines[i], pen, options); !r) return r;
        }
    return {};
}

Result<void> Canvas::begin(const RenderOptions& options, int samples) {
    const int width = options.width * options.supersampling, height = options.height * options.supersampling;
    GLint most_pixels = 0, most_samples = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most_pixels);
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    if (width > most_pixels || height > most_pixels)
        return refuse(RefusalKind::limit, "size",
                      text("needs ", std::max(width, height),
                           " pixels per side with supersampling, the driver has ", most_pixels));
    if (width != width_ || height != height_) {
        glDeleteFramebuffers(2, framebuffers_.data());
        glDeleteRenderbuffers(GLsizei(renderbuffers_.size()), renderbuffers_.data());
        renderbuffers_.clear();
        framebuffers_ = {
            make_framebuffer(width, height, 0, false, renderbuffers_),
            make_framebuffer(width, height, std::min(most_samples, samples), true, renderbuffers_)};
        width_ = width, height_ = height;
    }
    if (framebuffers_[0] == 0 || framebuffers_[1] == 0)
        return refuse(RefusalKind::limit, "size",
                      text("no memory for a picture of ", width, " x ", height, " pixels"));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[1]);
    glViewport(0, 0, width, height);
    glClear(GL_DEPTH_BUFFER_BIT);
    return {};
}

Result<Image> Canvas::finish(const RenderOptions& options) {
    // Resolve the samples, then read.
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[0]);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[0]);
    std::vector<unsigned char> rgba(4 * std::size_t(width_) * std::size_t(height_));
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        return refuse(error == GL_OUT_OF_MEMORY ? RefusalKind::limit : RefusalKind::unavailable, "OpenGL",
                      text("the driver reports error ", error));
    return averaged(rgba, options);
}

}  // namespace freiform
