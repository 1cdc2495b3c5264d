// The surfaces of a file in a window, by a renderer of its own: what the library gives are buffers and
// shaders. Drag to turn, scroll to zoom; the triangles are made anew for every picture.
//   gpu-window teapot.bpt
// With --hidden one picture is drawn into a window that is not shown, and its middle is printed. With
// --picture NAME three are shown, what the window has then is written as NAME-window.png, and what the
// library's own renderer makes of the same view as NAME-offscreen.png.
#include <freiform/gpu/surfaces.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <string_view>

namespace ff = freiform;

namespace {

struct Eye {
    double azimuth = 0.8, elevation = 0.6, zoom = 0.8, x = 0, y = 0;
} eye;

GLuint program_of(std::initializer_list<std::pair<GLenum, ff::SurfaceShader>> stages) {
    const GLuint program = glCreateProgram();
    for (const auto& [stage, which] : stages) {
        const std::string source = ff::shader_source(which);
        const char* text = source.c_str();
        const GLuint shader = glCreateShader(stage);
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
    }
    glLinkProgram(program);
    char log[1000] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    if (*log) std::cerr << log << '\n';
    return program;
}

// The camera of docs/gpu.md: rotated coordinates x right, y up, z to the eye; parallel rays.
void set_view(GLuint program, int width, int height, double edge_tolerance) {
    const double ca = std::cos(eye.azimuth), sa = std::sin(eye.azimuth), ce = std::cos(eye.elevation),
                 se = std::sin(eye.elevation);
    const float rotation[9] = {float(-sa), float(-se * ca), float(ce * ca),
                               float(ca),  float(-se * sa), float(ce * sa),
                               0,          float(ce),       float(se)};
    const double pixels = eye.zoom * std::min(width, height) / 2;
    float projection[16] = {};
    projection[0] = float(2 * pixels / width), projection[5] = float(2 * pixels / height);
    projection[10] = -0.5f, projection[15] = 1;
    const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUseProgram(program);
    glUniformMatrix3fv(at("rotation"), 1, GL_FALSE, rotation);
    glUniformMatrix4fv(at("projection"), 1, GL_FALSE, projection);
    glUniform3f(at("sky"), 0, float(ce), float(se));
    constexpr double kDeviation = 0.2;  // pixels
    glUniform1f(at("density"), float(pixels / kDeviation));
    glUniform2f(at("half_size"), float(width) / 2, float(height) / 2);
    const double reach = kDeviation + edge_tolerance * pixels + 0.05;
    glUniform1f(at("reach"), float(reach));
    glUniform1f(at("slopes"), float(reach + 1));
    glUniform1f(at("farther"), 1e-4f);
}

int refused(const ff::Refusal& r) {
    std::cerr << r.where << ": " << r.message << '\n';
    return 1;
}

// What the window shows, before it is exchanged: its samples are averaged on the way to pixels that can be
// read.
ff::Image shown(int width, int height) {
    GLuint pixels = 0, target = 0;
    glGenRenderbuffers(1, &pixels);
    glBindRenderbuffer(GL_RENDERBUFFER, pixels);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixels);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target);
    const std::size_t row = 3 * std::size_t(width);
    std::vector<unsigned char> rows(row * std::size_t(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    ff::Image image{width, height, {}};
    for (std::size_t y = std::size_t(height); y-- > 0;)
        image.rgb.insert(image.rgb.end(), rows.begin() + long(y * row), rows.begin() + long((y + 1) * row));
    return image;
}

// The same view by the library: a frame of the size of the window about the middle of the scene.
ff::Result<ff::Image> offscreen(const ff::SurfaceBuffers& surfaces, int width, int height) {
    const double ca = std::cos(eye.azimuth), sa = std::sin(eye.azimuth), ce = std::cos(eye.elevation),
                 se = std::sin(eye.elevation), pixels = eye.zoom * std::min(width, height) / 2;
    const ff::Vec<3> right{{-sa, ca, 0}}, up{{-se * ca, -se * sa, ce}}, to_eye{{ce * ca, ce * sa, se}},
        x = surfaces.size * width / 2 / pixels * right, y = surfaces.size * height / 2 / pixels * up,
        z = 2 * surfaces.size * to_eye;
    const std::array<ff::Vec<3>, 4> frame{surfaces.middle - x - y - z, surfaces.middle + x + y - z,
                                          surfaces.middle - x - y + z, surfaces.middle + x + y + z};
    auto renderer = ff::SurfaceRenderer::make(surfaces);
    if (!renderer) return std::unexpected(renderer.error());
    ff::RenderOptions options{.width = width, .height = height, .view = {eye.azimuth, eye.elevation}};
    options.outlines = false, options.supersampling = 1, options.margin = 0, options.frame = frame;
    options.top = options.bottom = {0.94f, 0.95f, 0.96f, 1};
    return renderer->draw(options);
}

ff::Result<void> write(const ff::Result<ff::Image>& image, const std::string& file) {
    if (!image) return std::unexpected(image.error());
    const auto png = ff::to_png(*image);
    if (!png) return std::unexpected(png.error());
    return ff::write_file(file, *png);
}

}  // namespace

int main(int argc, char** argv) {
    const bool hidden = argc == 3 && std::string_view(argv[2]) == "--hidden";
    const std::string picture = argc == 4 && std::string_view(argv[2]) == "--picture" ? argv[3] : "";
    if (argc != 2 && !hidden && picture.empty()) {
        std::cerr << "usage: gpu-window FILE [--hidden | --picture NAME]\n";
        return 2;
    }
    const auto document = ff::read_any(argv[1]);
    if (!document) return refused(document.error());
    const auto model = ff::scene_of(*document);
    if (!model) return refused(model.error());
    const auto surfaces =
        ff::surface_buffers(*model, {.edge_tolerance = ff::summary(*model).box.diagonal() / 16000});
    if (!surfaces) return refused(surfaces.error());

    if (!glfwInit()) return refused({ff::RefusalKind::unavailable, "GLFW", "no window system"});
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SAMPLES, 4);
    if (hidden) glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    GLFWwindow* window = glfwCreateWindow(1000, 750, "freiform", nullptr, nullptr);
    if (!window) return refused({ff::RefusalKind::unavailable, "OpenGL", "no window with OpenGL 4.3"});
    glfwMakeContextCurrent(window);

    // The buffer of texels that all shaders read.
    GLuint buffer = 0, texture = 0, none = 0, seams = 0, segments = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(surfaces->texels.size() * 16), surfaces->texels.data(),
                 GL_STATIC_DRAW);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
    glGenVertexArrays(1, &none);

    // The seams, instances of four vertices.
    glGenVertexArrays(1, &seams);
    glBindVertexArray(seams);
    glGenBuffers(1, &segments);
    glBindBuffer(GL_ARRAY_BUFFER, segments);
    constexpr auto kSize = GLsizei(sizeof(ff::SeamSegment));
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(surfaces->seams.size()) * kSize, surfaces->seams.data(),
                 GL_STATIC_DRAW);
    for (GLuint i = 0; i < 10; ++i) {  // eight points and normals, two colours
        const bool colour = i >= 8;
        const std::size_t offset = colour ? 96 + 4 * (i - 8) : 12 * i;
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, colour ? 4 : 3, colour ? GL_UNSIGNED_BYTE : GL_FLOAT, colour, kSize,
                              reinterpret_cast<const void*>(offset));
        glVertexAttribDivisor(i, 1);
    }
    static_assert(offsetof(ff::SeamSegment, colour) == 96 && sizeof(ff::SeamSegment) == 104);

    using enum ff::SurfaceShader;
    const GLuint patches = program_of({{GL_VERTEX_SHADER, patch_vertex},
                                       {GL_TESS_CONTROL_SHADER, patch_control},
                                       {GL_TESS_EVALUATION_SHADER, patch_evaluation},
                                       {GL_FRAGMENT_SHADER, surface_fragment}});
    const GLuint seam = program_of({{GL_VERTEX_SHADER, seam_vertex}, {GL_FRAGMENT_SHADER, seam_fragment}});
    GLint level = 64;
    glGetIntegerv(GL_MAX_TESS_GEN_LEVEL, &level);

    glfwSetScrollCallback(window, [](GLFWwindow*, double, double by) {
        eye.zoom = std::clamp(eye.zoom * std::exp2(by / 4), 0.1, 50.0);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        if (glfwGetMouseButton(w, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
            eye.azimuth -= 0.01 * (x - eye.x);
            eye.elevation = std::clamp(eye.elevation + 0.01 * (y - eye.y), -1.57, 1.57);
        }
        eye.x = x, eye.y = y;
    });
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.94f, 0.95f, 0.96f, 1);
    int width = 0, height = 0;
    ff::Image image;
    for (int frames = 1; !glfwWindowShouldClose(window); ++frames) {
        glfwGetFramebufferSize(window, &width, &height);
        glViewport(0, 0, width, height);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        set_view(patches, width, height, surfaces->edge_tolerance);
        glUniform1i(glGetUniformLocation(patches, "pieces"), surfaces->pieces);
        glUniform1i(glGetUniformLocation(patches, "faces"), surfaces->faces);
        glUniform1f(glGetUniformLocation(patches, "hardware_level"), float(level));
        // The piece that needs most says into how many cells the hardware's levels have to be cut.
        const double density = eye.zoom * std::min(width, height) / 2 / 0.2;
        float most = 0;
        for (const auto& bend : surfaces->bends) most = std::max({most, bend[0], bend[1]});
        const int cells = std::max(1, int(std::ceil((std::sqrt(most * density) + 1) / level)));
        glUniform1i(glGetUniformLocation(patches, "cells"), cells);
        glBindVertexArray(none);
        glPatchParameteri(GL_PATCH_VERTICES, 1);
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(1, 1);
        glDrawArraysInstanced(GL_PATCHES, 0, surfaces->tensor_pieces, cells * cells);
        glDisable(GL_POLYGON_OFFSET_FILL);
        set_view(seam, width, height, surfaces->edge_tolerance);
        glBindVertexArray(seams);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(surfaces->seams.size()));
        if (hidden) {
            unsigned char middle[4] = {};
            glReadPixels(width / 2, height / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, middle);
            std::cout << int(middle[0]) << ' ' << int(middle[1]) << ' ' << int(middle[2]) << '\n';
            break;
        }
        if (!picture.empty() && frames == 3) {
            image = shown(width, height);
            break;
        }
        glfwSwapBuffers(window);
        picture.empty() ? glfwWaitEvents() : glfwPollEvents();
    }
    glfwTerminate();
    if (picture.empty()) return 0;
    if (const auto ok = write(image, picture + "-window.png"); !ok) return refused(ok.error());
    if (const auto ok = write(offscreen(*surfaces, width, height), picture + "-offscreen.png"); !ok)
        return refused(ok.error());
}
