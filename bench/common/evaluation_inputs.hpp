// The curve, the surface and the parameters of the comparison of evaluation, made from splitmix64, so that
// every program has the same bits: cubic, clamped on [0, 1], weights between 1/2 and 2.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
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
inline CurveInput helix(int n = CurveInput::kSize, std::uint64_t seed = 3001) {
    Sequence random(seed);
    CurveInput c{uneven_knots(n, random), {}, {}};
    for (int i = 0; i < n; ++i) {
        const double s = i / (n - 1.0), turn = 4 * 3.14159265358979323846 * s;
        c.points.push_back(std::cos(turn) + 0.4 * (random.next() - 0.5));
        c.points.push_back(std::sin(turn) + 0.4 * (random.next() - 0.5));
        c.points.push_back(2 * s + 0.4 * (random.next() - 0.5));
        c.weights.push_back(0.5 + 1.5 * random.next());
    }
    return c;
}

struct SurfaceInput {
    int degree = 3, size = 20;                              // the same along both axes
    std::vector<double> knots_u, knots_v, points, weights;  // row-major, u slow
};
inline SurfaceInput hills(int n = 20, std::uint64_t seed = 1001) {
    Sequence random(seed);
    SurfaceInput s{3, n, {}, {}, {}, {}};
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

// n x n control points of any degree, equal spans on [0, 1].
inline SurfaceInput rough(int degree, int n) {
    SurfaceInput s{degree, n, {}, {}, {}, {}};
    for (int i = 0; i <= n + degree; ++i)
        s.knots_u.push_back(std::clamp(double(i - degree) / (n - degree), 0.0, 1.0));
    s.knots_v = s.knots_u;
    Sequence random(std::uint64_t(1000 * degree + n));
    for (int i = 0; i < n * n; ++i) {
        s.points.insert(s.points.end(), {double(i / n) / n, double(i % n) / n, 0.1 * random.next()});
        s.weights.push_back(0.5 + 1.5 * random.next());
    }
    return s;
}

inline constexpr int kPoints = 1000000, kGrid = 1000;
inline std::vector<double> scattered(std::uint64_t seed, std::size_t count = kPoints) {
    Sequence random(seed);
    std::vector<double> v(count);
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

}  // namespace freiform::bench
