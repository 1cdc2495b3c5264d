// Where preparing, threads and stores past the caches begin to pay. tools/bench_thresholds.py runs it and
// compares with what the library has set (worth_preparing, kParallelFrom, kPastFrom).
#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <benchmark/benchmark.h>
#include <kernel/evaluate.hpp>
#include <numeric>
#include <patches.hpp>

namespace {

using namespace freiform;

Surface<Hom<3>> surface_of(int degree, int n) { return bench::patch_of(bench::rough(degree, n)); }
Curve<Hom<3>> curve_of(int degree, int n) {
    const auto s = bench::rough(degree, n);
    const std::size_t count = std::size_t(n);
    return *Curve<Hom<3>>::make(
        {*BSplineBasis::make(degree, s.knots_u)},
        bench::net_of<1>({n}, {s.points.begin(), s.points.begin() + 3 * n},
                         {s.weights.begin(), s.weights.begin() + std::ptrdiff_t(count)}));
}
Volume<Hom<3>> volume_of(int degree, int n) {
    const auto s = surface_of(degree, n);
    std::vector<Hom<3>> net;
    for (int i = 0; i < n; ++i) net.insert(net.end(), s.net().flat().begin(), s.net().flat().end());
    return *Volume<Hom<3>>::make({s.basis(0), s.basis(0), s.basis(0)},
                                 Net<3, Hom<3>>({n, n, n}, std::move(net)));
}
template <std::size_t N>
auto patch_of(const benchmark::State& state) {
    const int degree = int(state.range(0)), n = int(state.range(1));
    if constexpr (N == 1)
        return curve_of(degree, n);
    else if constexpr (N == 2)
        return surface_of(degree, n);
    else
        return volume_of(degree, n);
}
template <std::size_t N>
std::vector<Param<N>> parameters(std::size_t n) {
    bench::Sequence random(2001);
    std::vector<Param<N>> at(n);
    for (auto& p : at)
        if constexpr (N == 1)
            p = random.next();
        else
            for (double& x : p) x = random.next();
    return at;
}

// Degree and control points along a side. Making the tables; a point of order K without and with them.
template <std::size_t N>
void prepare(benchmark::State& state) {
    const auto patch = patch_of<N>(state);
    for (auto _ : state) benchmark::DoNotOptimize(PreparedPatch<N, Hom<3>>::make(patch));
    state.SetItemsProcessed(state.iterations());
}
template <std::size_t N, int K>
void one_by_one(benchmark::State& state) {
    const auto patch = patch_of<N>(state);
    const auto at = parameters<N>(64);
    std::vector<Jet<N, K, Vec<3>>> out(at.size());
    std::vector<Vec<3>> points(at.size());
    for (auto _ : state) {
        for (std::size_t i = 0; i < at.size(); ++i)
            if constexpr (K == 0)
                points[i] = patch(at[i]);
            else
                out[i] = patch.template jet<K>(at[i]);
        benchmark::DoNotOptimize(out.data());
        benchmark::DoNotOptimize(points.data());
    }
    state.SetItemsProcessed(state.iterations() * 64);
}
template <std::size_t N, int K>
void batch(benchmark::State& state) {
    const auto fast = PreparedPatch<N, Hom<3>>::make(patch_of<N>(state));
    const auto at = parameters<N>(512);
    std::vector<Jet<N, K, Vec<3>>> out(at.size());
    for (auto _ : state) {
        if (!fast->evaluate(at, std::span(out))) state.SkipWithError("refused");
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * 512);
}

// Square grids without tables and with tables made for each of them: of the points along a side.
std::vector<double> side(std::int64_t n) {
    std::vector<double> axis;
    for (int i = 0; i < n; ++i) axis.push_back((i + 0.5) / double(n));
    return axis;
}
void grid_unprepared(benchmark::State& state) {
    const auto patch = patch_of<2>(state);
    const auto axis = side(state.range(2));
    for (auto _ : state) {
        const auto map = [&](std::size_t d) { return collocation(patch.basis(int(d)), axis); };
        const Net<2, Hom<3>> rows = along(0, map(0), patch.net()), all = along(1, map(1), rows);
        std::vector<Vec<3>> out;
        for (const auto& h : all.flat()) out.push_back(project(h));
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(2) * state.range(2));
}
void grid_prepared(benchmark::State& state) {
    const auto patch = patch_of<2>(state);
    const auto axis = side(state.range(2));
    for (auto _ : state) {
        std::vector<Vec<3>> out(axis.size() * axis.size());
        const auto fast = PreparedPatch<2, Hom<3>>::make(patch);
        if (!fast->evaluate_grid({axis, axis}, out)) state.SkipWithError("refused");
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(2) * state.range(2));
}

// So many points of a bicubic surface in pieces of 4096 on so many threads, by the clock.
void threads(benchmark::State& state) {
    const auto fast = PreparedPatch<2, Hom<3>>::make(surface_of(3, 20));
    const auto at = parameters<2>(std::size_t(state.range(0)));
    std::vector<Vec<3>> out(at.size());
    constexpr std::size_t kPiece = 4096;
    for (auto _ : state) {
        set_max_threads(int(state.range(1)));
        parallel_for((at.size() + kPiece - 1) / kPiece, 1, [&](std::size_t i) {
            const std::size_t first = i * kPiece, n = std::min(kPiece, at.size() - first);
            if (!fast->evaluate(std::span(at).subspan(first, n), std::span(out).subspan(first, n)))
                std::abort();
        });
        benchmark::DoNotOptimize(out.data());
    }
    set_max_threads(1);
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

// The last axis of a grid on one rational cubic piece: what stores the most bytes in a time.
struct Row {
    static constexpr int kCount = 1024;  // points
    std::vector<kernel::GridPart> part;
    std::vector<double> weights,
        outer{0, 0, 0, 1, 1, 0.5, 1, 1, 2, 1, -1, 0.5, 3, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0};
    kernel::GridAxis axis;
    Row() {
        const int width = kernel::kernels().width;
        axis = {kCount, 3, width, 0, kCount / width, nullptr, nullptr};
        for (int group = 0; group < axis.parts; ++group) {
            part.push_back({group, 0});
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < width; ++i) {
                    const double t = double(group * width + i) / kCount, s = 1 - t;
                    weights.push_back(j == 0   ? s * s * s
                                      : j == 1 ? 3 * s * s * t
                                      : j == 2 ? 3 * s * t * t
                                               : t * t * t);
                }
        }
        axis.part = part.data(), axis.weights = weights.data();
    }
};

// So many KiB of rows: whether past the caches, and whether they are read afterwards. The memory has been
// written before, as it has where it is used again.
void stores(benchmark::State& state) {
    const Row row;
    kernel::Net net;
    net.axes = 2, net.dim = 3, net.rational = true;
    std::vector<Vec<3>> out(std::size_t(state.range(0)) * 1024 / sizeof(Vec<3>) / Row::kCount * Row::kCount);
    for (auto _ : state) {
        for (std::size_t first = 0; first < out.size(); first += Row::kCount)
            kernel::kernels().grid_row(net, row.axis, row.outer.data(), 16,
                                       {0, 1, out[first].c.data(), nullptr, nullptr, state.range(1) != 0});
        kernel::kernels().flush();
        if (state.range(2) != 0) benchmark::DoNotOptimize(std::accumulate(out.begin(), out.end(), Vec<3>()));
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(out.size()));
}

template <std::size_t N>
void shapes(benchmark::internal::Benchmark* b) {
    const int size = N == 3 ? 10 : 20;
    for (const int degree : {1, 3, 5}) b->Args({degree, size});
    b->Args({3, 4});
    if (N < 3) b->Args({3, 100});
}
#define FF_SHAPES(N)                                        \
    BENCHMARK_TEMPLATE(prepare, N)->Apply(shapes<N>);       \
    BENCHMARK_TEMPLATE(one_by_one, N, 0)->Apply(shapes<N>); \
    BENCHMARK_TEMPLATE(one_by_one, N, 1)->Apply(shapes<N>); \
    BENCHMARK_TEMPLATE(one_by_one, N, 2)->Apply(shapes<N>); \
    BENCHMARK_TEMPLATE(batch, N, 0)->Apply(shapes<N>);      \
    BENCHMARK_TEMPLATE(batch, N, 1)->Apply(shapes<N>);      \
    BENCHMARK_TEMPLATE(batch, N, 2)->Apply(shapes<N>)
FF_SHAPES(1);
FF_SHAPES(2);
FF_SHAPES(3);
#undef FF_SHAPES

void sides(benchmark::internal::Benchmark* b) {
    for (const int size : {4, 20, 100})
        for (const int n : {4, 8, 12, 16, 24, 32, 48, 64, 100}) b->Args({3, size, n});
}
BENCHMARK(grid_unprepared)->Apply(sides);
BENCHMARK(grid_prepared)->Apply(sides);

void counts(benchmark::internal::Benchmark* b) {
    for (int n = 8192; n <= 262144; n *= 2)
        for (const int on : {1, 2}) b->Args({n, on});
}
BENCHMARK(threads)->Apply(counts)->UseRealTime();

void sizes(benchmark::internal::Benchmark* b) {
    for (int n = 256; n <= 65536; n *= 2)
        for (const int past : {0, 1})
            for (const int read : {0, 1}) b->Args({n, past, read});
}
BENCHMARK(stores)->Apply(sizes);

}  // namespace

int main(int argc, char** argv) {
    set_max_threads(1);
    benchmark::Initialize(&argc, argv);
    benchmark::AddCustomContext("kernels", std::string(instruction_set()));
    benchmark::RunSpecifiedBenchmarks();
}
