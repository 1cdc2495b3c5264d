// Time of a point against the number of points, the degree and the number of control points; many small
// patches at once. tools/bench_micro.py runs it and draws.
#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <benchmark/benchmark.h>
#include <evaluation_inputs.hpp>

namespace {

using namespace freiform;

// A rational surface of n x n control points, uniform clamped knots on [0, 1].
Surface<Hom<3>> surface_of(int degree, int n) {
    std::vector<double> knots;
    for (int i = 0; i <= n + degree; ++i)
        knots.push_back(std::clamp(double(i - degree) / (n - degree), 0.0, 1.0));
    const auto basis = *BSplineBasis::make(degree, knots);
    bench::Sequence random(std::uint64_t(1000 * degree + n));
    std::vector<Hom<3>> net;
    for (int i = 0; i < n * n; ++i) {
        const Vec<3> p{{double(i / n) / n, double(i % n) / n, 0.1 * random.next()}};
        net.push_back(weighted(p, 0.5 + 1.5 * random.next()));
    }
    return *Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({n, n}, std::move(net)));
}

std::vector<Param<2>> parameters(std::size_t n) {
    bench::Sequence random(2001);
    std::vector<Param<2>> at(n);
    for (auto& p : at) p = {random.next(), random.next()};
    return at;
}

// Points scattered over a surface: of them, of its degree, of its control points along each side.
void scattered(benchmark::State& state) {
    const auto fast = PreparedPatch<2, Hom<3>>::make(surface_of(int(state.range(1)), int(state.range(2))));
    const auto at = parameters(std::size_t(state.range(0)));
    std::vector<Vec<3>> out(at.size());
    for (auto _ : state) {
        if (!fast->evaluate(at, out)) state.SkipWithError("refused");
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
// The same with one point after the other.
void single(benchmark::State& state) {
    const auto surface = surface_of(int(state.range(1)), int(state.range(2)));
    const auto at = parameters(std::size_t(state.range(0)));
    std::vector<Vec<3>> out(at.size());
    for (auto _ : state) {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = surface(at[i]);
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
void curvatures(benchmark::State& state) {
    const auto fast = PreparedPatch<2, Hom<3>>::make(surface_of(int(state.range(1)), int(state.range(2))));
    const auto at = parameters(std::size_t(state.range(0)));
    std::vector<Curvatures> out(at.size());
    for (auto _ : state) {
        if (!fast->evaluate(at, out)) state.SkipWithError("refused");
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
// Square grids of so many points along each side.
void grid(benchmark::State& state) {
    const auto fast = PreparedPatch<2, Hom<3>>::make(surface_of(int(state.range(1)), int(state.range(2))));
    std::vector<double> axis;
    for (int i = 0; i < state.range(0); ++i) axis.push_back((i + 0.5) / double(state.range(0)));
    std::vector<Vec<3>> out(axis.size() * axis.size());
    for (auto _ : state) {
        if (!fast->evaluate_grid({axis, axis}, out)) state.SkipWithError("refused");
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(out.size()));
}

// A thousand bicubic patches on a grid of so many points along each side.
struct ManyPatches {
    std::vector<Surface<Hom<3>>> patches;
    std::vector<double> axis;
    std::vector<Vec<3>> out;
    explicit ManyPatches(const benchmark::State& state) : patches(1000, surface_of(3, 4)) {
        for (int i = 0; i < state.range(0); ++i) axis.push_back(double(i) / double(state.range(0) - 1));
        out.resize(patches.size() * axis.size() * axis.size());
    }
    std::span<const Surface<Hom<3>>> all() const { return patches; }
    std::array<std::span<const double>, 2> axes() const { return {axis, axis}; }
};
void many_at_once(benchmark::State& state) {
    ManyPatches job(state);
    for (auto _ : state) {
        if (!evaluate_grids(job.all(), job.axes(), std::span(job.out))) state.SkipWithError("refused");
        benchmark::DoNotOptimize(job.out.data());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(job.out.size()));
}
void many_in_a_loop(benchmark::State& state) {
    ManyPatches job(state);
    const std::size_t each = job.axis.size() * job.axis.size();
    for (auto _ : state) {
        for (std::size_t k = 0; k < job.patches.size(); ++k) {
            const auto fast = PreparedPatch<2, Hom<3>>::make(job.patches[k]);
            if (!fast->evaluate_grid(job.axes(), std::span(job.out).subspan(k * each, each)))
                state.SkipWithError("refused");
        }
        benchmark::DoNotOptimize(job.out.data());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(job.out.size()));
}

void points_degree_size(benchmark::internal::Benchmark* b) {
    for (const int points : {1, 8, 64, 512, 4096, 32768, 262144}) b->Args({points, 3, 20});
    for (const int degree : {1, 2, 4, 5, 7, 9}) b->Args({4096, degree, 20});
    for (const int size : {4, 8, 50, 100, 200}) b->Args({4096, 3, size});
}

BENCHMARK(scattered)->Apply(points_degree_size);
BENCHMARK(single)
    ->Args({64, 3, 20})
    ->Args({64, 1, 20})
    ->Args({64, 5, 20})
    ->Args({64, 9, 20})
    ->Args({64, 3, 200});
BENCHMARK(curvatures)->Args({4096, 3, 20});
BENCHMARK(grid)->Args({8, 3, 20})->Args({30, 3, 20})->Args({100, 3, 20})->Args({300, 3, 20});
BENCHMARK(many_at_once)->Arg(4)->Arg(10)->Arg(20);
BENCHMARK(many_in_a_loop)->Arg(4)->Arg(10)->Arg(20);

}  // namespace

int main(int argc, char** argv) {
    set_max_threads(1);
    benchmark::Initialize(&argc, argv);
    benchmark::AddCustomContext("kernels", std::string(instruction_set()));
    benchmark::RunSpecifiedBenchmarks();
}
