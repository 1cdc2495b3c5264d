// What all programs of the comparison of curves share: the curve as text, the clock, the lines of the answer.
//
//     degree n rational(0|1)    then n + degree + 1 knots, n times (w x, w y, w z, w), a count, the
//     parameters
//
// as hexadecimal doubles, white space between them. The answer has a line for each task:
//     task seconds [name=number ..]
#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace freiform::bench {

using Point3 = std::array<double, 3>;

struct SpaceCurve {
    int degree = 0;
    bool rational = false;
    std::vector<double> knots;
    std::vector<std::array<double, 4>> net;  // weighted
    std::vector<double> sorted, random;      // parameters

    double lo() const { return knots[std::size_t(degree)]; }
    double hi() const { return knots[net.size()]; }
};

inline double next_double() {
    char word[64];
    if (std::scanf("%63s", word) != 1) {
        std::fprintf(stderr, "the input ends too early\n");
        std::exit(2);
    }
    return std::strtod(word, nullptr);
}

inline SpaceCurve read_space_curve() {
    SpaceCurve c;
    c.degree = int(next_double());
    const int n = int(next_double());
    c.rational = next_double() != 0;
    for (int i = 0; i < n + c.degree + 1; ++i) c.knots.push_back(next_double());
    for (int i = 0; i < n; ++i) {
        c.net.emplace_back();
        for (double& x : c.net.back()) x = next_double();
    }
    const int count = int(next_double());
    for (int i = 0; i < count; ++i) c.random.push_back(next_double());
    c.sorted = c.random;
    std::sort(c.sorted.begin(), c.sorted.end());
    return c;
}

// The shortest of many runs of `job`, in seconds: what others do on the machine only adds time.
template <class F>
double shortest(F&& job, double budget = 0.4) {
    using Clock = std::chrono::steady_clock;
    double best = 1e300, all = 0;
    for (int i = 0; i < 5 || (all < budget && i < 2000); ++i) {
        const auto start = Clock::now();
        job();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        best = std::min(best, seconds);
        all += seconds;
    }
    return best;
}

// The largest distance of samples of the curve from the segment that stands for them: 15 in each.
template <class F>
double strays(const std::vector<double>& at, const std::vector<Point3>& points, F&& curve) {
    double worst = 0;
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
        for (int k = 1; k < 16; ++k) {
            const Point3 p = curve(at[i] + (at[i + 1] - at[i]) * k / 16);
            double along = 0, length = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const double d = points[i + 1][c] - points[i][c];
                along += d * (p[c] - points[i][c]);
                length += d * d;
            }
            const double s = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
            double square = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const double d = points[i][c] + s * (points[i + 1][c] - points[i][c]) - p[c];
                square += d * d;
            }
            worst = std::max(worst, std::sqrt(square));
        }
    return worst;
}

inline constexpr double kFlattenTo[] = {1e-2, 1e-4, 1e-6};
inline constexpr double kLengthTo = 1e-9;

}  // namespace freiform::bench
