// The C++ side of bench/PYTHON.md: a million points of a cubic curve and of a bicubic surface, both rational,
// prepared; into fresh memory, as a new array in Python has it, and into memory that is there. Prints
// nanoseconds per point on one thread and on all, of the clock and of the processor: the medians of 15 runs,
// after one that is not counted.
#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>

namespace {

using namespace freiform;

struct Time {
    double clock = 0, processor = 0;  // nanoseconds per point
};

double processor_now() { return double(std::clock()) * (1e9 / CLOCKS_PER_SEC); }

double median(std::vector<double>& times) {
    std::ranges::nth_element(times, times.begin() + std::ptrdiff_t(times.size() / 2));
    return times[times.size() / 2];
}

template <class F>
Time time_per_point(std::size_t n, F&& f) {
    f();
    std::vector<double> clock, processor;
    for (int run = 0; run < 15; ++run) {
        const double before = processor_now();
        const auto start = std::chrono::steady_clock::now();
        f();
        clock.push_back(
            std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
        processor.push_back(processor_now() - before);
    }
    return {median(clock) / double(n), median(processor) / double(n)};
}

// What tools/bench_python.py makes, too.
Hom<3> coefficient(int i, int j) {
    return weighted(Vec<3>{{double(i), double(j), std::sin(i + 0.5 * j)}}, 1 + 0.1 * ((i + j) % 3));
}

template <std::size_t N>
void measure(const char* name, const std::array<int, N>& size, const std::vector<Param<N>>& at) {
    std::array<BSplineBasis, N> bases = [&]<std::size_t... D>(std::index_sequence<D...>) {
        return std::array<BSplineBasis, N>{*BSplineBasis::clamped_uniform(3, size[D])...};
    }
    (std::make_index_sequence<N>{});
    Net<N, Hom<3>> net(size);
    each_index(size, [&](const Index<N>& i) { net.view()(i) = coefficient(i[0], N == 2 ? i[N - 1] : 0); });
    const auto patch = PreparedPatch<N, Hom<3>>::make(*Patch<N, Hom<3>>::make(bases, net));
    for (const int threads : {1, 0}) {
        set_max_threads(threads);
        const auto print = [&](const char* memory, const Time& t) {
            std::printf("%s %s %s %.3f %.3f\n", name, threads == 1 ? "one" : "all", memory, t.clock,
                        t.processor);
        };
        print("fresh", time_per_point(at.size(), [&] {
                  const auto out = std::make_unique_for_overwrite<double[]>(3 * at.size());
                  (void)patch->evaluate(at, {reinterpret_cast<Vec<3>*>(out.get()), at.size()});
              }));
        std::vector<Vec<3>> out(at.size());
        print("reused", time_per_point(at.size(), [&] { (void)patch->evaluate(at, out); }));
    }
}

}  // namespace

int main() {
    constexpr int n = 1'000'000;
    std::vector<double> t(n);
    std::vector<std::array<double, 2>> uv(n);
    for (int i = 0; i < n; ++i) {
        const double a = std::fmod(i * 0.6180339887498949, 1.0), b = std::fmod(i * 0.7548776662466927, 1.0);
        t[std::size_t(i)] = a * 97;
        uv[std::size_t(i)] = {a * 17, b * 17};
    }
    measure<1>("curve", {100}, t);
    measure<2>("surface", {20, 20}, uv);
}
