// The state of a renderer of surfaces: how it is made is in surface_setup.cpp, how it draws in
// surface_renderer.cpp.
#pragma once
#include "gpu/context.hpp"
#include "gpu/gl_tools_detail.hpp"

namespace freiform {

struct SurfaceRenderer::State {
    SurfaceBuffers data;
    SurfacePipeline pipeline;
    std::unique_ptr<GlContext> context;
    GlPrograms programs{""};
    GLuint patches = 0, triangle_patches = 0, grid = 0, seam = 0, captured = 0, captured_triangles = 0;
    GLuint texture = 0, buffer = 0;
    GLint hardware_level = 64;
    bool middles = false;  // of pixels decide what is trimmed
    VertexArray none, seams;
    std::vector<SceneLine> outlines;
    Canvas canvas;

    GlslDialect dialect() const {
        return pipeline == SurfacePipeline::grid ? GlslDialect::gles300 : GlslDialect::gl430;
    }
    GLenum target() const { return pipeline == SurfacePipeline::grid ? GL_TEXTURE_2D : GL_TEXTURE_BUFFER; }
    Result<void> prepare();
    Result<void> upload();
    Result<GLuint> link(std::initializer_list<std::pair<GLenum, SurfaceShader>> shaders,
                        const std::vector<const char*>& captures = {});
    double density(const GpuScene& scene, double deviation) const;
    Result<void> check_work(double density) const;
    void set_pieces(GLuint program, const GpuScene& scene, double density) const;
    int set_patches(GLuint program, const GpuScene& scene, double density, bool triangular) const;
    void draw_patches(bool triangular, int cells) const;
    void draw_grids(GLuint program, const GpuScene& scene, double density) const;
    Result<void> draw_seams(const GpuScene& scene, const RenderOptions& options, double deviation) const;
    RenderOptions sampled(const RenderOptions& options) const;
    Result<void> draw(const RenderOptions& options, double deviation);
    Result<std::vector<SurfaceVertex>> capture(const RenderOptions& options, double deviation);
};

}  // namespace freiform
