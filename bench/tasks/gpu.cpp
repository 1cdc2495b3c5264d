// Surfaces by shaders against meshes and against the kernels of the processor, as a table in Markdown:
//   bench-gpu FILE ..
// FREIFORM_SIZE=1600x1200: another size of pictures; FREIFORM_TIME=processor: what all threads of the program
// take, instead of the clock on the wall: for renderers in software on a machine with other work. Pictures of
// a file: by tessellation shaders and by instanced grids, from a renderer that is ready; as a mesh that is
// there, by render(), which uploads it; and how long that mesh takes to make. Then points of one surface.
#include <freiform/gpu/surfaces.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/assemble.hpp>
#include <freiform/model/tessellate.hpp>
#include <freiform/spline/prepared.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string_view>

namespace {

using namespace freiform;

constexpr double kMeshTolerance = 1.0 / 2000;  // of the model: what `freiform draw` takes
constexpr int kRuns = 7;

double now() {
    static const char* const kind = std::getenv("FREIFORM_TIME");
    if (kind && std::string_view(kind) == "processor") return double(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The median; the first run, which compiles shaders, is left out.
double seconds_of(const std::function<bool()>& job) {
    std::vector<double> t;
    for (int i = 0; i <= kRuns; ++i) {
        const double start = now();
        if (!job()) return -1;
        t.push_back(now() - start);
    }
    t.erase(t.begin());
    std::nth_element(t.begin(), t.begin() + kRuns / 2, t.end());
    return t[kRuns / 2];
}

RenderOptions picture_options() {
    RenderOptions o;
    o.width = 1200, o.height = 900, o.supersampling = 1;
    if (const char* size = std::getenv("FREIFORM_SIZE")) std::sscanf(size, "%dx%d", &o.width, &o.height);
    return o;
}

void print_row(const std::string& name, const Model& model) {
    const double size = summary(model).box.diagonal();
    const auto buffers = surface_buffers(model, {.edge_tolerance = size / 16000});
    if (!buffers) {
        std::printf("| %s | %s: %s |\n", name.c_str(), buffers.error().where.c_str(),
                    buffers.error().message.c_str());
        return;
    }
    const RenderOptions options = picture_options();
    auto tessellated = SurfaceRenderer::make(*buffers),
         grid = SurfaceRenderer::make(*buffers, SurfacePipeline::grid);
    if (!tessellated || !grid) {
        std::printf("| %s | %s |\n", name.c_str(),
                    (tessellated ? grid : tessellated).error().message.c_str());
        return;
    }
    const auto triangles = tessellated->triangles(options);
    const double by_patches = seconds_of([&] { return tessellated->draw(options).has_value(); });
    const double by_grids = seconds_of([&] { return grid->draw(options).has_value(); });
    TessellateOptions how;
    how.tolerance = size * kMeshTolerance;
    Result<Tessellation> mesh = tessellate(model, how);
    const double made = seconds_of([&] { return (mesh = tessellate(model, how)).has_value(); });
    const double by_mesh = seconds_of([&] { return render(mesh->mesh, options).has_value(); });
    const double count = double(triangles ? triangles->size() / 3 : 0);
    std::printf("| %s | %zu | %.0f | %.1f | %.1f | %.1f | %zu | %.1f | %.1f | %.2f | %.2f |\n", name.c_str(),
                model.faces.size(), count, 1 / by_patches, count / by_patches * 1e-6, 1 / by_grids,
                mesh->mesh.triangles.size(), 1 / by_mesh, 1e3 * made, by_mesh / by_patches,
                (made + by_mesh) / by_patches);
}

// A rational bicubic surface of 20 x 20 control points.
Surface<Hom<3>> rational_surface() {
    constexpr int kSize = 20;
    const auto basis = *BSplineBasis::clamped_uniform(3, kSize);
    Net<2, Hom<3>> net({kSize, kSize});
    each_index(net.extent(), [&](const Index<2>& k) {
        net.view()(k) =
            weighted(Vec<3>{{double(k[0]), double(k[1]), std::sin(k[0] * 1.7) * std::cos(k[1] * 0.9)}},
                     1 + 0.5 * ((k[0] + k[1]) % 2));
    });
    return *Surface<Hom<3>>::make({basis, basis}, net);
}

// It at a million places.
void print_points() {
    constexpr std::size_t kPoints = 1'000'000;
    const auto surface = rational_surface();
    const Interval on = surface.domain()[0];
    std::vector<Param<2>> at(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
        const auto part = [&](double x) { return on.lo + on.length() * (x - std::floor(x)); };
        at[i] = {part(double(i) * std::numbers::phi), part(double(i) * std::numbers::sqrt2)};
    }
    std::vector<Vec<3>> points(kPoints), normals(kPoints);
    const auto prepared = *PreparedPatch<2, Hom<3>>::make(surface);
    const double cpu = seconds_of([&] { return prepared.evaluate(at, points).has_value(); });
    const double cpu_normals = seconds_of([&] { return prepared.evaluate(at, points, normals).has_value(); });
    std::printf(
        "\n| points, 10^6 a second | points | ratio | with normals | ratio |\n|---|---:|---:|---:|---:|\n");
    std::printf("| kernel of the processor, all threads | %.1f | 1 | %.1f | 1 |\n", 1e-6 * kPoints / cpu,
                1e-6 * kPoints / cpu_normals);
    for (const auto& [name, precision] : {std::pair("compute shader, float", ShaderPrecision::single),
                                          std::pair("compute shader, double", ShaderPrecision::twice)}) {
        auto shader = SurfaceEvaluator::make(surface, precision);
        if (!shader) {
            std::printf("| %s | %s |\n", name, shader.error().message.c_str());
            continue;
        }
        const double plain = seconds_of([&] { return shader->evaluate(at, points, {}).has_value(); });
        const double both = seconds_of([&] { return shader->evaluate(at, points, normals).has_value(); });
        std::printf("| %s, transfers included | %.1f | %.2f | %.1f | %.2f |\n", name, 1e-6 * kPoints / plain,
                    cpu / plain, 1e-6 * kPoints / both, cpu_normals / both);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const RenderOptions options = picture_options();
    std::printf("Pictures of %d x %d, 4 samples a pixel.\n\n", options.width, options.height);
    std::printf(
        "| model | faces | triangles | pictures/s | 10^6 triangles/s | pictures/s, grids | triangles of the "
        "mesh | "
        "pictures/s, mesh | mesh made in ms | shaders against mesh | against making and drawing it |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (int i = 1; i < argc; ++i) {
        const auto document = read_any(argv[i]);
        const auto model = document ? scene_of(*document) : Result<Model>(std::unexpected(document.error()));
        if (!model) {
            std::printf("| %s | %s |\n", argv[i], model.error().message.c_str());
            continue;
        }
        print_row(std::filesystem::path(argv[i]).filename().string(), *model);
    }
    ModelBuilder rational;
    if (rational.add(rational_surface()))
        if (const auto model = std::move(rational).finish())
            print_row("rational bicubic, 17 x 17 pieces", *model);
    print_points();
}
