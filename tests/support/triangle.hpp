// Triangles for tests, and their nets in exact arithmetic.
#pragma once
#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/simplex.hpp>

namespace freiform::test {

template <class P>
SimplexPatch<2, P> random_triangle(Random& random, int n) {
    std::vector<P> b;
    for (int i = 0; i < (n + 1) * (n + 2) / 2; ++i) b.push_back(random_coefficient<P>(random));
    return must(SimplexPatch<2, P>::make(n, b));
}

using ExactNet = std::vector<std::vector<Rational>>;
template <class P>
ExactNet exact_net(const SimplexPatch<2, P>& s) {
    ExactNet out;
    for (const P& p : s.coefficients()) out.emplace_back(p.c.begin(), p.c.end());
    return out;
}

// One step of de Casteljau at u, of a net of degree m.
inline ExactNet exact_step(const ExactNet& b, int m, const std::array<Rational, 2>& u) {
    const auto slot = [](int j, int k) { return SimplexPatch<2, Vec<1>>::slot(j, k); };
    ExactNet out(std::size_t(m * (m + 1) / 2));
    for (int r = 0; r < m; ++r)
        for (int k = 0; k <= r; ++k)
            for (std::size_t c = 0; c < b[0].size(); ++c)
                out[slot(r - k, k)].push_back((1 - u[0] - u[1]) * b[slot(r - k, k)][c] +
                                              u[0] * b[slot(r - k + 1, k)][c] +
                                              u[1] * b[slot(r - k, k + 1)][c]);
    return out;
}
inline ExactNet exact_step(const ExactNet& b, int m, const Param<2>& u) {
    return exact_step(b, m, std::array{Rational(u[0]), Rational(u[1])});
}

// The exact homogeneous value.
inline std::vector<Rational> exact_value(ExactNet b, int n, const std::array<Rational, 2>& u) {
    for (int m = n; m > 0; --m) b = exact_step(b, m, u);
    return b[0];
}
// The exact point.
template <class P>
std::vector<Rational> exact_point(const SimplexPatch<2, P>& s, const std::array<Rational, 2>& u) {
    auto h = exact_value(exact_net(s), s.degree(), u);
    if (!Space<P>::kRational) return h;
    for (std::size_t c = 0; c + 1 < h.size(); ++c) h[c] /= h.back();
    h.pop_back();
    return h;
}

// The distance of two exact points, rounded at the end.
inline double distance(const std::vector<Rational>& a, const std::vector<Rational>& b) {
    Rational sum = 0;
    for (std::size_t c = 0; c < a.size(); ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return std::sqrt(sum.convert_to<double>());
}

}  // namespace freiform::test
