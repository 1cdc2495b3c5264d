// What the programs of the comparison of evaluation share: tasks with Google Benchmark, whose results
// tools/bench_evaluation.py compares.
#pragma once
#include <benchmark/benchmark.h>
#include <evaluation_inputs.hpp>
#include <string>

namespace freiform::bench {

// Times of `job`, which makes so many points. `sample` is a number of the result: programs whose samples
// differ have not done the same. Time of the thread, which other jobs of the machine disturb less than that
// of the clock; `wall`: by the clock, for several threads.
template <class Job, class Sample>
void task(const std::string& name, std::size_t points, Job job, Sample sample, bool wall = false) {
    auto* registered = benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        for (auto _ : state) job();
        state.SetItemsProcessed(state.iterations() * std::int64_t(points));
        state.counters["sample"] = double(sample());
    });
    if (wall) registered->UseRealTime();
}

// f(points, degree, size) for what the plots show: the number of points, the degree, the number of control
// points along a side.
template <class F>
void each_sweep(F f) {
    for (const int points : {1, 8, 64, 512, 4096, 32768, 262144}) f(points, 3, 20);
    for (const int degree : {1, 2, 4, 5, 7, 9}) f(4096, degree, 20);
    for (const int size : {4, 8, 50, 100, 200}) f(4096, 3, size);
}
inline std::string sweep_name(const char* job, int points, int degree, int size) {
    return std::string(job) + "/" + std::to_string(points) + "/" + std::to_string(degree) + "/" +
           std::to_string(size);
}

// Runs what was registered. Of freiform the record says also which kernels ran, the bound of values of the
// surface, and how many processors two threads got that only count.
inline int run_tasks(int argc, char** argv, const std::string& kernels = "", double bound = 0,
                     double processors = 0) {
    benchmark::Initialize(&argc, argv);
    if (!kernels.empty()) {
        benchmark::AddCustomContext("kernels", kernels);
        benchmark::AddCustomContext("bound", std::to_string(bound * 1e15) + "e-15");
        benchmark::AddCustomContext("processors", std::to_string(processors));
    }
    return benchmark::RunSpecifiedBenchmarks() == 0;
}

}  // namespace freiform::bench
