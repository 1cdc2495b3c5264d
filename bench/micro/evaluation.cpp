// Derivatives and curvatures against the degree, grids, many small patches at once. tools/bench_micro.py runs
// it.
#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <benchmark/benchmark.h>
#include <patches.hpp>

namespace {

using namespace freiform;

Surface<Hom<3>> surface_of(int degree, int n) { return bench::patch_of(bench::rough(degree, n)); }

std::vector<Param<2>> parameters(std::size_t n) {
    bench::Sequence random(2001);
    std::vector<Param<2>> at(n);
    for (auto& p : at) p = {random.next(), random.next()};
    return at;
}

// Points scattered over a surface of 20 x 20 control points: of them, of its degree.
template <class Out>
void scattered(benchmark::State& state) {
    const auto fast = PreparedPatch<2, Hom<3>>::make(surface_of(int(state.range(1)), 20));
    const auto at = parameters(std::size_t(state.range(0)));
    std::vector<Out> out(at.size());
    for (auto _ : state) {
        if (!fast->evaluate(at, std::span(out))) state.SkipWithError("refused");
        benchmark::DoNotOptimize(out.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
void first_derivatives(benchmark::State& state) { scattered<Jet<2, 1, Vec<3>>>(state); }
void second_derivatives(benchmark::State& state) { scattered<Jet<2, 2, Vec<3>>>(state); }
void curvatures(benchmark::State& state) { scattered<Curvatures>(state); }

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

void degrees(benchmark::internal::Benchmark* b) {
    for (const int degree : {1, 2, 3, 4, 5, 7}) b->Args({4096, degree});
}

BENCHMARK(first_derivatives)->Apply(degrees);
BENCHMARK(second_derivatives)->Apply(degrees);
BENCHMARK(curvatures)->Apply(degrees);
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
