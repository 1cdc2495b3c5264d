// The curve, the surface and the parameters of the comparison of evaluation, made from splitmix64, so that
// every program has the same bits: cubic, clamped on [0, 1], weights between 1/2 and 2.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <vector>

namespace freiform::bench {

class Sequence {
public:
    explicit Sequence(std::uint64_t seed) : state_(seed) {}
    double next() {  // in [0, 1)
        std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_;
};

// Spans of lengths 1/4 to 5/4, scaled to [0, 1].
inline std::vector<double> uneven_knots(int n, Sequence& random) {
    const int spans = n - 3;
    std::vector<double> width, t(std::size_t(n) + 4);
    double sum = 0, at = 0;
    for (int i = 0; i < spans; ++i) width.push_back(0.25 + random.next()), sum += width.back();
    for (std::size_t i = 0; i < 4; ++i) t[i] = 0, t[std::size_t(n) + i] = 1;
    for (int i = 1; i < spans; ++i) t[std::size_t(3 + i)] = at += width[std::size_t(i - 1)] / sum;
    return t;
}

struct CurveInput {
    static constexpr int kSize = 100;
    std::vector<double> knots, points, weights;  // points: x y z, not weighted
};
inline CurveInput helix() {
    Sequence random(3001);
    CurveInput c{uneven_knots(CurveInput::kSize, random), {}, {}};
    for (int i = 0; i < CurveInput::kSize; ++i) {
        const double s = i / (CurveInput::kSize - 1.0), turn = 4 * 3.14159265358979323846 * s;
        c.points.push_back(std::cos(turn) + 0.4 * (random.next() - 0.5));
        c.points.push_back(std::sin(turn) + 0.4 * (random.next() - 0.5));
        c.points.push_back(2 * s + 0.4 * (random.next() - 0.5));
        c.weights.push_back(0.5 + 1.5 * random.next());
    }
    return c;
}

struct SurfaceInput {
    static constexpr int kSize = 20;
    std::vector<double> knots_u, knots_v, points, weights;  // row-major, u slow
};
inline SurfaceInput hills() {
    constexpr int n = SurfaceInput::kSize;
    Sequence random(1001);
    SurfaceInput s;
    s.knots_u = uneven_knots(n, random);
    s.knots_v = uneven_knots(n, random);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double a = random.next() - 0.5, b = random.next() - 0.5, c = random.next() - 0.5;
            const double x = i / (n - 1.0) + 0.2 * a / (n - 1), y = j / (n - 1.0) + 0.2 * b / (n - 1);
            s.points.insert(s.points.end(), {x, y, 0.15 * std::sin(6 * x) * std::cos(5 * y) + 0.1 * c});
            s.weights.push_back(0.5 + 1.5 * random.next());
        }
    return s;
}

inline constexpr int kPoints = 1000000, kGrid = 1000;
inline std::vector<double> scattered(std::uint64_t seed) {
    Sequence random(seed);
    std::vector<double> v(kPoints);
    for (double& x : v) x = random.next();
    return v;
}
inline std::vector<double> sorted(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v;
}
inline std::vector<double> grid_axis() {
    std::vector<double> v;
    for (int i = 0; i < kGrid; ++i) v.push_back((i + 0.5) / kGrid);
    return v;
}

// Prints the task and the quartiles of the time of a point, in nanoseconds, over some runs of `job`; `sample`
// is a number of the result, by which programs are compared. Time of the processor, which other jobs of the
// machine disturb less than that of the clock; of several threads (`wall`) by the clock.
template <class Job, class Sample>
void task(const char* name, Job&& job, Sample&& sample, bool wall = false) {
    const auto now = [&] {
        timespec t{};
        clock_gettime(wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &t);
        return 1e9 * double(t.tv_sec) + double(t.tv_nsec);
    };
    std::vector<double> ns;
    for (int i = 0; i < 9; ++i) {
        const double start = now();
        job();
        ns.push_back((now() - start) / kPoints);
    }
    std::sort(ns.begin(), ns.end());
    std::printf("%s %.6g %.6g %.6g %.6g %.17g\n", name, ns[0], ns[2], ns[4], ns[6], double(sample()));
    std::fflush(stdout);
}

}  // namespace freiform::bench
