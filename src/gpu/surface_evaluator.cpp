// Batches of parameters by a compute shader: evaluate.comp. In single precision parameters are taken from the
// lower end of the domain, so that where it lies costs no digits.
#include "gpu/context.hpp"
#include "gpu/gl_tools_detail.hpp"

#include <freiform/spline/bezier.hpp>

#include <algorithm>

namespace freiform {

namespace {

constexpr std::size_t kMostAtOnce = std::size_t(1) << 22;  // parameters
constexpr GLuint kGroup = 64, kGroupsInRow = 32768;        // a driver has at least 65535

template <class T>
void fill_storage(GLuint binding, GLuint buffer, const std::vector<T>& data) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, GLsizeiptr(data.size() * sizeof(T)), data.data(), GL_STATIC_DRAW);
}

}  // namespace

struct SurfaceEvaluator::State {
    std::unique_ptr<GlContext> context;
    GLuint program = 0;
    std::array<GLuint, 5> buffers{};
    std::array<double, 2> from{};
    bool twice = false;

    template <class Real>
    Result<void> load(const Surface<Hom<3>>& surface);
    template <class Real>
    Result<void> evaluate(std::span<const Param<2>> at, std::span<Vec<3>> points, std::span<Vec<3>> normals);
};

template <class Real>
Result<void> SurfaceEvaluator::State::load(const Surface<Hom<3>>& surface) {
    const auto pieces = decompose(surface);
    const Index<2> extent = pieces.extent();
    std::vector<Real> coefficients, breaks;
    each_index(extent, [&](const Index<2>& k) {
        const auto net = pieces.net(k);
        each_index(net.extent, [&](const Index<2>& i) {
            for (const double x : net(i).c) coefficients.push_back(Real(x));
        });
    });
    for (const int axis : {0, 1}) {
        from[std::size_t(axis)] = pieces.breaks(axis).front();
        for (const double b : pieces.breaks(axis)) breaks.push_back(Real(b - from[std::size_t(axis)]));
    }
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (coefficients.size() * sizeof(Real) > std::size_t(most))
        return refuse(RefusalKind::limit, "OpenGL",
                      text("needs ", coefficients.size() * sizeof(Real), " bytes, the driver has ", most));
    glGenBuffers(GLsizei(buffers.size()), buffers.data());
    fill_storage(0, buffers[0], coefficients);
    fill_storage(1, buffers[1], breaks);
    glUseProgram(program);
    glUniform2i(place(program, "extent"), extent[0], extent[1]);
    glUniform2i(place(program, "degree"), pieces.degree(0), pieces.degree(1));
    return {};
}

template <class Real>
Result<void> SurfaceEvaluator::State::evaluate(std::span<const Param<2>> at, std::span<Vec<3>> points,
                                               std::span<Vec<3>> normals) {
    glUseProgram(program);
    std::vector<Real> parameters, out;
    for (std::size_t begin = 0; begin < at.size(); begin += kMostAtOnce) {
        const auto part = at.subspan(begin, std::min(kMostAtOnce, at.size() - begin));
        parameters.clear();
        for (const Param<2>& u : part)
            for (const std::size_t d : {std::size_t(0), std::size_t(1)})
                parameters.push_back(Real(u[d] - from[d]));
        out.assign(3 * part.size(), Real(0));
        fill_storage(2, buffers[2], parameters);
        fill_storage(3, buffers[3], out);
        fill_storage(4, buffers[4], normals.empty() ? std::vector<Real>(3) : out);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0]);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[1]);
        glUniform1i(place(program, "count"), GLint(part.size()));
        glUniform1i(place(program, "with_normals"), !normals.empty());
        const GLuint groups = GLuint((part.size() + kGroup - 1) / kGroup);
        glDispatchCompute(std::min(groups, kGroupsInRow), (groups + kGroupsInRow - 1) / kGroupsInRow, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        const auto read = [&](GLuint buffer, std::span<Vec<3>> to) {
            glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
            glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, GLsizeiptr(out.size() * sizeof(Real)),
                               out.data());
            for (std::size_t i = 0; i < part.size(); ++i)
                for (std::size_t d = 0; d < 3; ++d) to[begin + i][int(d)] = double(out[3 * i + d]);
        };
        read(buffers[3], points);
        if (!normals.empty()) read(buffers[4], normals);
    }
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        return refuse(error == GL_OUT_OF_MEMORY ? RefusalKind::limit : RefusalKind::unavailable, "OpenGL",
                      text("the driver reports error ", error));
    return {};
}

SurfaceEvaluator::SurfaceEvaluator(std::unique_ptr<State> state) : state_(std::move(state)) {}
SurfaceEvaluator::SurfaceEvaluator(SurfaceEvaluator&&) noexcept = default;
SurfaceEvaluator& SurfaceEvaluator::operator=(SurfaceEvaluator&&) noexcept = default;
SurfaceEvaluator::~SurfaceEvaluator() = default;

Result<SurfaceEvaluator> SurfaceEvaluator::make(const Surface<Hom<3>>& surface, ShaderPrecision precision) {
    auto context = GlContext::make(GlVersion::core_43);
    if (!context) return std::unexpected(context.error());
    auto state = std::make_unique<State>();
    state->context = std::move(*context);
    state->twice = precision == ShaderPrecision::twice;
    auto program =
        link_program({{GL_COMPUTE_SHADER, shader_source(state->twice ? SurfaceShader::evaluate_double
                                                                     : SurfaceShader::evaluate_float)}});
    if (program) state->program = *program;
    const Result<void> ready = !program       ? std::unexpected(program.error())
                               : state->twice ? state->load<double>(surface)
                                              : state->load<float>(surface);
    state->context->release();
    if (!ready) return std::unexpected(ready.error());
    return SurfaceEvaluator(std::move(state));
}

Result<void> SurfaceEvaluator::evaluate(std::span<const Param<2>> at, std::span<Vec<3>> points,
                                        std::span<Vec<3>> normals) {
    FF_REQUIRE(points.size() == at.size() && (normals.empty() || normals.size() == at.size()));
    if (!state_->context->use())
        return refuse(RefusalKind::unavailable, "OpenGL", "the context cannot be used again");
    const auto done = state_->twice ? state_->evaluate<double>(at, points, normals)
                                    : state_->evaluate<float>(at, points, normals);
    state_->context->release();
    return done;
}

}  // namespace freiform
