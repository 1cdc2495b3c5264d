// A curve, a surface, points to be near to, and the true distances by the plain method.
//
// The plain method: many samples, and from each that is nearer than its neighbours and nearly the nearest of
// all, steps that are halved when no neighbour is nearer. It proves nothing, but no program here has been
// seen to find a nearer point. Lines of the answer:
//     task seconds_per_point right=.. wrong=.. none=.. beaten=.. worst=..
#pragma once
#include "evaluation_inputs.hpp"

#include <array>
#include <cstddef>
#include <cstdio>
#include <ctime>

namespace freiform::bench {

using Place3 = std::array<double, 3>;

inline double apart(const Place3& a, const Place3& b) {
    double s = 0;
    for (std::size_t k = 0; k < 3; ++k) s += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(s);
}

// The cubic B-splines that are not zero at t, and the index of the first.
struct FourCubics {
    std::size_t first = 0;
    std::array<double, 4> b{};
    FourCubics(const std::vector<double>& knots, double t) {
        const std::size_t n = knots.size() - 4;
        const auto after = std::upper_bound(knots.begin() + 4, knots.begin() + std::ptrdiff_t(n), t);
        const std::size_t s = std::size_t(after - knots.begin()) - 1;
        first = s - 3;
        b[0] = 1;
        for (std::size_t k = 1; k <= 3; ++k) {
            double carry = 0;
            for (std::size_t r = 0; r < k; ++r) {
                const double left = knots[s + 1 - k + r], right = knots[s + 1 + r], q = b[r] / (right - left);
                b[r] = carry + (right - t) * q;
                carry = (t - left) * q;
            }
            b[k] = carry;
        }
    }
};

inline Place3 value(const CurveInput& c, const std::array<double, 1>& t) {
    const FourCubics f(c.knots, t[0]);
    Place3 p{};
    double w = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double x = f.b[i] * c.weights[f.first + i];
        for (std::size_t k = 0; k < 3; ++k) p[k] += x * c.points[3 * (f.first + i) + k];
        w += x;
    }
    for (double& x : p) x /= w;
    return p;
}
inline Place3 value(const SurfaceInput& s, const std::array<double, 2>& t) {
    const FourCubics f(s.knots_u, t[0]), g(s.knots_v, t[1]);
    Place3 p{};
    double w = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            const std::size_t at = (f.first + i) * (s.knots_v.size() - 4) + g.first + j;
            const double x = f.b[i] * g.b[j] * s.weights[at];
            for (std::size_t k = 0; k < 3; ++k) p[k] += x * s.points[3 * at + k];
            w += x;
        }
    for (double& x : p) x /= w;
    return p;
}

// Uniform in the box of the control points, `stretched` about its middle.
inline std::vector<Place3> points_around(const std::vector<double>& net, const Place3& stretched, int count,
                                         std::uint64_t seed) {
    Place3 lo{1e9, 1e9, 1e9}, hi{-1e9, -1e9, -1e9};
    for (std::size_t i = 0; i < net.size(); ++i) {
        lo[i % 3] = std::min(lo[i % 3], net[i]);
        hi[i % 3] = std::max(hi[i % 3], net[i]);
    }
    Sequence random(seed);
    std::vector<Place3> q(static_cast<std::size_t>(count));
    for (Place3& p : q)
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = (lo[k] + hi[k]) / 2 + (hi[k] - lo[k]) / 2 * stretched[k] * (2 * random.next() - 1);
    return q;
}

template <class Input, std::size_t N>
struct NearestTask {
    const char* name;
    Input input;
    std::vector<Place3> queries;

    Place3 at(const std::array<double, N>& t) const { return value(input, t); }

    // From t, in steps of `step` and finer.
    double refined(const Place3& q, std::array<double, N> t, double step) const {
        double best = apart(at(t), q);
        for (; step > 1e-10; step /= 2)
            for (bool better = true; better;) {
                better = false;
                for (int code = 0; code < (N == 1 ? 3 : 9); ++code) {
                    std::array<double, N> s = t;
                    for (std::size_t d = 0, c = std::size_t(code); d < N; ++d, c /= 3)
                        s[d] = std::clamp(t[d] + (double(c % 3) - 1) * step, 0.0, 1.0);
                    const double x = apart(at(s), q);
                    if (x < best) best = x, t = s, better = true;
                }
            }
        return best;
    }

    std::vector<double> true_distances() const {
        const int m = N == 1 ? 20000 : 300, side = m + 1, total = N == 1 ? side : side * side;
        std::vector<Place3> samples(static_cast<std::size_t>(total));
        const auto place = [&](int i) {
            std::array<double, N> t{};
            t[0] = double(N == 1 ? i : i / side) / m;
            if constexpr (N == 2) t[1] = double(i % side) / m;
            return t;
        };
        for (int i = 0; i < total; ++i) samples[std::size_t(i)] = at(place(i));
        std::vector<double> truth, d(samples.size());
        for (const Place3& q : queries) {
            double least = 1e300;
            for (std::size_t i = 0; i < d.size(); ++i) least = std::min(least, d[i] = apart(samples[i], q));
            double best = 1e300;
            for (int i = 0; i < total; ++i) {
                if (d[std::size_t(i)] > least + 0.006) continue;
                bool lowest = true;
                const int x = N == 1 ? i : i / side, y = N == 1 ? 0 : i % side;
                for (int a = std::max(x - 1, 0); a <= std::min(x + 1, m); ++a)
                    for (int b = std::max(y - 1, 0); b <= std::min(y + 1, N == 1 ? 0 : m); ++b)
                        lowest = lowest && d[std::size_t(N == 1 ? a : a * side + b)] >= d[std::size_t(i)];
                if (lowest) best = std::min(best, refined(q, place(i), 0.5 / m));
            }
            truth.push_back(best);
        }
        return truth;
    }

    // Runs job(found), which fills in the parameters for each point (NaN: none), and prints what came out.
    template <class Job>
    void judge(const char* method, const std::vector<double>& truth, Job&& job) const {
        const auto now = [] {  // of the processor: other jobs of the machine disturb it less than the clock
            timespec t{};
            clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
            return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
        };
        std::vector<std::array<double, N>> found(queries.size());
        std::vector<double> seconds;
        double all = 0;
        while (seconds.size() < 3 || (all < 0.5 && seconds.size() < 200)) {
            const double start = now();
            job(found);
            seconds.push_back(now() - start);
            all += seconds.back();
        }
        std::sort(seconds.begin(), seconds.end());
        long right = 0, wrong = 0, none = 0, beaten = 0;
        double worst = 0;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            if (!std::isfinite(found[i][0])) {
                ++none;
                continue;
            }
            const double off = apart(at(found[i]), queries[i]) - truth[i];
            right += off <= 1e-6, wrong += off > 1e-6, beaten += off < -1e-7;
            worst = std::max(worst, off);
        }
        std::printf("%s%s %.9g right=%ld wrong=%ld none=%ld beaten=%ld worst=%.2g\n", name, method,
                    seconds[seconds.size() / 2] / double(queries.size()), right, wrong, none, beaten, worst);
        std::fflush(stdout);
    }
};

inline NearestTask<CurveInput, 1> nearest_on_curve() {
    const CurveInput c = helix(30, 5001);
    return {"curve", c, points_around(c.points, {1.2, 1.2, 1.2}, 10000, 5002)};
}
inline NearestTask<SurfaceInput, 2> nearest_on_surface() {
    const SurfaceInput s = hills(10, 6001);
    return {"surface", s, points_around(s.points, {1.2, 1.2, 3}, 2000, 6002)};
}

}  // namespace freiform::bench
