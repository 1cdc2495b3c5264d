// Surfaces on the graphics card, without a mesh.
//
// Idea. A piece becomes a patch of one control point, its number; the control stage reads how finely it has
// to be cut, the evaluation stage its coefficients. The fragment stage trims. Without tessellation stages
// instances of a grid do the same.
//
// No cracks. Within a face neighbouring pieces have the same points on their common side
// (surface_buffers.cpp, bezier.glsl). Between faces: what is drawn of a face ends in the points of its
// triangles at the places of its parameter curve, which are within `deviation` of that curve on the surface
// at the same parameter; the seam's segments are within the tolerance of edges of it, and fill what lies
// between face and edge. A seam reaches beyond its segments by both distances, and by rounding. So the
// outlines that two faces are drawn with, and all between them, are covered by their two seams: if the
// pictures of the faces themselves leave no gap, nothing of what is behind is seen. Seams lie deeper than the
// faces, by what these fall within the reach, so that they are hidden where faces are drawn; beyond a
// silhouette they have the light of the face that is turned to the eye.
//
// Cost. A picture costs the evaluation of its vertices; nothing is made per view by the processor but lists
// of pieces for grids.
//
// Accuracy. As surface_buffers.cpp; beyond the boundary of a face its seam may be seen by the reach, with
// that less than half a pixel for the usual deviation of 0.2. Edges of one face have seams too: faces of
// surface models often meet without sharing them.
//
// Why not one polyline for an edge, to which both faces are drawn: fragments of the pieces would have to be
// cut off or pulled there; a mesh is the better way then. Why not trimming a little outside: a face that is
// seen edge on would reach far in front of or behind its neighbour, and untrimmed faces end with their
// surface.
#include "gpu/surface_renderer_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

constexpr double kMostCells = 1e7;          // of a picture
constexpr double kRoundingReach = 0.05;     // pixels of the framebuffer
constexpr float kSeamFarther = 1e-4f;       // in depth from -1 to 1
constexpr float kOrientationBow = 1.7321f;  // the scene reaches no nearer to the eye: the corner of a cube

struct Levels {
    int u = 1, v = 1;
};
// No fewer than the shaders find in floats.
Levels levels_of(const std::array<float, 2>& bend, double density) {
    const auto of = [&](double b) {
        return int(std::min(std::max(std::ceil(std::sqrt(b * density) * (1 + 1e-5)), 1.0), 1e6));
    };
    return {of(bend[0]), of(bend[1])};
}

int power_of_two(int n) {
    int p = 1;
    while (p < n) p *= 2;
    return p;
}

}  // namespace

// Pixels of the framebuffer that a unit has where it is nearest to the eye, for one pixel of deviation.
double SurfaceRenderer::State::density(const GpuScene& scene, double deviation) const {
    return scene.pixels / (1 - double(scene.inverse_distance) * kOrientationBow) / deviation;
}

Result<void> SurfaceRenderer::State::check_work(double density) const {
    double cells = 0;
    for (const auto& bend : data.bends) {
        const Levels n = levels_of(bend, density);
        cells += double(n.u) * n.v;
    }
    if (cells > kMostCells)
        return refuse(RefusalKind::limit, "deviation",
                      text("the picture needs ", cells, " cells, more than ", kMostCells));
    return {};
}

void SurfaceRenderer::State::set_pieces(GLuint program, const GpuScene& scene, double density) const {
    glUseProgram(program);
    set_camera(program, scene);
    glUniform1i(place(program, "pieces"), data.pieces);
    glUniform1i(place(program, "faces"), data.faces);
    glUniform1i(place(program, "data"), 0);
    glUniform1f(place(program, "density"), float(density));
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(target(), texture);
}

// Returns how many cells in each direction the piece has that needs most.
int SurfaceRenderer::State::set_patches(GLuint program, const GpuScene& scene, double density,
                                        bool triangular) const {
    const int first = triangular ? data.tensor_pieces : 0,
              count = triangular ? data.triangles : data.tensor_pieces;
    set_pieces(program, scene, density);
    int most = 1;
    for (int i = first; i < first + count; ++i) {
        const Levels n = levels_of(data.bends[std::size_t(i)], density);
        most = std::max({most, n.u, n.v});
    }
    const int cells = (most + hardware_level - 1) / hardware_level;
    glUniform1i(place(program, "first_piece"), first);
    glUniform1i(place(program, "cells"), cells);
    glUniform1f(place(program, "hardware_level"), float(hardware_level));
    glBindVertexArray(none.array);
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    return cells;
}

void SurfaceRenderer::State::draw_patches(bool triangular, int cells) const {
    glDrawArraysInstanced(GL_PATCHES, 0, triangular ? data.triangles : data.tensor_pieces, cells * cells);
}

void SurfaceRenderer::State::draw_grids(GLuint program, const GpuScene& scene, double density) const {
    std::map<std::pair<int, int>, std::vector<float>> groups;
    for (std::size_t i = 0; i < data.bends.size(); ++i) {
        const Levels n = levels_of(data.bends[i], density);
        groups[{power_of_two(n.u), power_of_two(n.v)}].push_back(float(i));
    }
    set_pieces(program, scene, density);
    for (const auto& [side, list] : groups) {
        VertexArray array;
        array.begin();
        array.fill(GL_ARRAY_BUFFER, list);
        array.attribute(0, 1, GL_FLOAT, sizeof(float), 0, 1);
        glUniform2i(place(program, "side"), side.first, side.second);
        glDrawArraysInstanced(GL_TRIANGLES, 0, 6 * side.first * side.second, GLsizei(list.size()));
        array.release();
    }
}

Result<void> SurfaceRenderer::State::draw_seams(const GpuScene& scene, const RenderOptions& options,
                                                double deviation) const {
    const double nearest = 1 / (1 - double(scene.inverse_distance) * kOrientationBow);
    const double reach =
        options.supersampling * (deviation + data.edge_tolerance * scene.pixels * nearest) + kRoundingReach;
    glUseProgram(seam);
    set_camera(seam, scene);
    set_light(seam, scene, options, options.painting == Painting::normals ? 2 : 0);
    glUniform2f(place(seam, "half_size"), float(options.width * options.supersampling) / 2,
                float(options.height * options.supersampling) / 2);
    glUniform1f(place(seam, "reach"), float(reach));
    glUniform1f(place(seam, "farther"), kSeamFarther);
    glUniform1f(place(seam, "slopes"), float(reach + options.supersampling));
    glUniform1f(place(seam, "inverse_distance"), scene.inverse_distance);
    glBindVertexArray(seams.array);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(data.seams.size()));
    return {};
}

// OpenGL ES trims whole pixels. Where several samples belong to one, the samples of a pixel whose middle lies
// between two faces would stay open, farther away than seams reach. So each sample is a pixel there.
RenderOptions SurfaceRenderer::State::sampled(const RenderOptions& options) const {
    RenderOptions out = options;
    GLint most = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    if (middles && 2 * options.supersampling * std::max(options.width, options.height) <= most)
        out.supersampling *= 2;
    return out;
}

// `options` as sampled() has them.
Result<void> SurfaceRenderer::State::draw(const RenderOptions& options, double deviation) {
    const GpuScene scene = make_scene(data, options);
    const double dense = density(scene, deviation);
    if (auto r = check_work(dense); !r) return r;
    if (auto r = canvas.begin(options, middles ? 0 : 4); !r) return r;
    if (auto r = draw_background(programs, options); !r) return r;
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(float(options.supersampling), 1);
    for (const GLuint program : {grid, patches, triangle_patches}) {
        if (program == 0) continue;
        glUseProgram(program);
        set_light(program, scene, options, options.painting == Painting::normals ? 2 : 0);
        if (program == grid)
            draw_grids(program, scene, dense);
        else
            draw_patches(program == triangle_patches,
                         set_patches(program, scene, dense, program == triangle_patches));
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
    if (auto r = draw_seams(scene, options, deviation); !r) return r;
    if (options.outlines)
        if (auto r = draw_lines(programs, scene, outlines, kOutlinePen, options); !r) return r;
    return draw_user_lines(programs, scene, options);
}

SurfaceRenderer::SurfaceRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
SurfaceRenderer::SurfaceRenderer(SurfaceRenderer&&) noexcept = default;
SurfaceRenderer& SurfaceRenderer::operator=(SurfaceRenderer&&) noexcept = default;
SurfaceRenderer::~SurfaceRenderer() = default;

Result<SurfaceRenderer> SurfaceRenderer::make(SurfaceBuffers buffers, SurfacePipeline pipeline) {
    auto context = GlContext::make(pipeline == SurfacePipeline::grid ? GlVersion::es_30 : GlVersion::core_43);
    if (!context) return std::unexpected(context.error());
    auto state = std::make_unique<State>();
    state->data = std::move(buffers);
    state->pipeline = pipeline;
    state->context = std::move(*context);
    const auto ready = state->prepare();
    state->context->release();
    if (!ready) return std::unexpected(ready.error());
    return SurfaceRenderer(std::move(state));
}

namespace {

Result<void> check_surface_options(const RenderOptions& options, double deviation) {
    if (auto r = check(options); !r) return r;
    if (!(deviation > 0 && std::isfinite(deviation)))
        return refuse(RefusalKind::invalid, "deviation",
                      text(deviation, " is not a positive number of pixels"));
    if (options.painting == Painting::sequential || options.painting == Painting::diverging)
        return refuse(RefusalKind::unsupported, "painting", "fields are given at the vertices of a mesh");
    if (options.edges)
        return refuse(RefusalKind::unsupported, "edges", "there is no mesh to draw the edges of");
    return {};
}

}  // namespace

Result<Image> SurfaceRenderer::draw(const RenderOptions& options, double deviation) {
    if (auto r = check_surface_options(options, deviation); !r) return std::unexpected(r.error());
    if (!state_->context->use())
        return refuse(RefusalKind::unavailable, "OpenGL", "the context cannot be used again");
    const RenderOptions sampled = state_->sampled(options);
    const auto drawn = state_->draw(sampled, deviation);
    auto image = drawn ? state_->canvas.finish(sampled) : Result<Image>(std::unexpected(drawn.error()));
    state_->context->release();
    return image;
}

Result<std::vector<SurfaceVertex>> SurfaceRenderer::triangles(const RenderOptions& options,
                                                              double deviation) {
    FF_REQUIRE(state_->pipeline == SurfacePipeline::tessellation);
    if (auto r = check_surface_options(options, deviation); !r) return std::unexpected(r.error());
    if (!state_->context->use())
        return refuse(RefusalKind::unavailable, "OpenGL", "the context cannot be used again");
    auto out = state_->capture(options, deviation);
    state_->context->release();
    return out;
}

}  // namespace freiform
