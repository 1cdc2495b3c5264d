// Programs and buffers of a renderer of surfaces, and the triangles that it draws.
#include "gpu/surface_renderer_detail.hpp"

namespace freiform {

namespace {

constexpr int kRowTexels = 4096;  // of the texture that OpenGL ES reads

}  // namespace

Result<GLuint> SurfaceRenderer::State::link(std::initializer_list<std::pair<GLenum, SurfaceShader>> shaders,
                                            const std::vector<const char*>& captures) {
    std::vector<ShaderPart> parts;
    for (const auto& [stage, shader] : shaders) parts.push_back({stage, shader_source(shader, dialect())});
    return link_program(parts, captures);
}

Result<void> SurfaceRenderer::State::upload() {
    GLint most = 0;
    glGenTextures(1, &texture);
    if (pipeline == SurfacePipeline::tessellation) {
        glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
        if (data.texels.size() > std::size_t(most))
            return refuse(RefusalKind::limit, "OpenGL",
                          text("needs ", data.texels.size(), " texels, the driver has ", most));
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_TEXTURE_BUFFER, buffer);
        glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(data.texels.size() * sizeof(data.texels[0])),
                     data.texels.data(), GL_STATIC_DRAW);
        glBindTexture(GL_TEXTURE_BUFFER, texture);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
        return {};
    }
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    const std::size_t rows = (data.texels.size() + kRowTexels - 1) / kRowTexels;
    if (rows > std::size_t(most) || kRowTexels > most)
        return refuse(RefusalKind::limit, "OpenGL",
                      text("needs a texture of ", rows, " rows, the driver has ", most));
    std::vector<std::array<float, 4>> padded = data.texels;
    padded.resize(rows * kRowTexels);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kRowTexels, GLsizei(rows), 0, GL_RGBA, GL_FLOAT,
                 padded.data());
    for (const auto filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, GLenum(filter), GL_NEAREST);
    return {};
}

Result<void> SurfaceRenderer::State::prepare() {
    using enum SurfaceShader;
    programs = GlPrograms(version_line(dialect()));
    const auto keep = [](GLuint& to, const Result<GLuint>& made) -> Result<void> {
        if (!made) return std::unexpected(made.error());
        to = *made;
        return {};
    };
    if (pipeline == SurfacePipeline::grid) {
        for (int i = 0; i < data.tensor_pieces + data.triangles; ++i)
            middles = middles || data.texels[std::size_t(data.pieces + 4 * i + 2)][3] > 0.5f;
        if (auto r =
                keep(grid, link({{GL_VERTEX_SHADER, grid_vertex}, {GL_FRAGMENT_SHADER, surface_fragment}}));
            !r)
            return r;
    } else {
        glGetIntegerv(GL_MAX_TESS_GEN_LEVEL, &hardware_level);
        const auto patch_program = [&](SurfaceShader evaluation) {
            return link({{GL_VERTEX_SHADER, patch_vertex},
                         {GL_TESS_CONTROL_SHADER, patch_control},
                         {GL_TESS_EVALUATION_SHADER, evaluation},
                         {GL_FRAGMENT_SHADER, surface_fragment}});
        };
        if (data.tensor_pieces > 0)
            if (auto r = keep(patches, patch_program(patch_evaluation)); !r) return r;
        if (data.triangles > 0)
            if (auto r = keep(triangle_patches, patch_program(triangle_evaluation)); !r) return r;
    }
    if (auto r = keep(seam, link({{GL_VERTEX_SHADER, seam_vertex}, {GL_FRAGMENT_SHADER, seam_fragment}})); !r)
        return r;
    if (auto r = upload(); !r) return r;
    none.begin();
    seams.begin();
    seams.fill(GL_ARRAY_BUFFER, data.seams);
    constexpr std::size_t kStride = sizeof(SeamSegment);
    const std::array offsets{offsetof(SeamSegment, from),        offsetof(SeamSegment, to),
                             offsetof(SeamSegment, edge_from),   offsetof(SeamSegment, edge_to),
                             offsetof(SeamSegment, normal_from), offsetof(SeamSegment, normal_to),
                             offsetof(SeamSegment, other_from),  offsetof(SeamSegment, other_to)};
    for (GLuint i = 0; i < offsets.size(); ++i) seams.attribute(i, 3, GL_FLOAT, kStride, offsets[i], 1);
    seams.attribute(8, 4, GL_UNSIGNED_BYTE, kStride, offsetof(SeamSegment, colour), 1);
    seams.attribute(9, 4, GL_UNSIGNED_BYTE, kStride, offsetof(SeamSegment, other_colour), 1);
    for (const OutlineSegment& o : data.outlines) outlines.push_back({o.from, o.to});
    return {};
}

Result<std::vector<SurfaceVertex>> SurfaceRenderer::State::capture(const RenderOptions& options,
                                                                   double deviation) {
    using enum SurfaceShader;
    GpuScene scene = make_scene(data, options);
    const double dense = density(scene, deviation);
    if (auto r = check_work(dense); !r) return std::unexpected(r.error());
    if (auto r = canvas.begin(options); !r) return std::unexpected(r.error());
    scene.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::vector<SurfaceVertex> out;
    glEnable(GL_RASTERIZER_DISCARD);
    for (const bool triangular : {false, true}) {
        if ((triangular ? data.triangles : data.tensor_pieces) == 0) continue;
        GLuint& program = triangular ? captured_triangles : captured;
        if (program == 0) {
            auto made =
                link({{GL_VERTEX_SHADER, patch_vertex},
                      {GL_TESS_CONTROL_SHADER, patch_control},
                      {GL_TESS_EVALUATION_SHADER, triangular ? triangle_evaluation : patch_evaluation}},
                     {"place", "direction", "at", "piece_number"});
            if (!made) return std::unexpected(made.error());
            program = *made;
        }
        // Once to count, once to keep.
        GLuint query = 0, count = 0;
        glGenQueries(1, &query);
        const int cells = set_patches(program, scene, dense, triangular);
        glBeginQuery(GL_PRIMITIVES_GENERATED, query);
        draw_patches(triangular, cells);
        glEndQuery(GL_PRIMITIVES_GENERATED);
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &count);
        glDeleteQueries(1, &query);
        const std::size_t vertices = 3 * std::size_t(count), before = out.size();
        static_assert(sizeof(SurfaceVertex) == 9 * sizeof(float));
        GLuint kept = 0;
        glGenBuffers(1, &kept);
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, kept);
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, GLsizeiptr(vertices * sizeof(SurfaceVertex)), nullptr,
                     GL_STREAM_READ);
        glBeginTransformFeedback(GL_TRIANGLES);
        draw_patches(triangular, cells);
        glEndTransformFeedback();
        out.resize(before + vertices);
        glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, GLsizeiptr(vertices * sizeof(SurfaceVertex)),
                           out.data() + before);
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
        glDeleteBuffers(1, &kept);
    }
    glDisable(GL_RASTERIZER_DISCARD);
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        return refuse(RefusalKind::unavailable, "OpenGL", text("the driver reports error ", error));
    return out;
}

}  // namespace freiform
