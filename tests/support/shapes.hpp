// Geometry of every kind for tests: curves and surfaces as models have them.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace freiform::test {

inline double uniform(std::mt19937& rng, double lo, double hi) {
    return lo + (hi - lo) * double(rng() >> 5) * 0x1p-27;
}

template <class P>
P random_coefficient(std::mt19937& rng, double weight_lo = 0.3) {
    P p;
    for (int i = 0; i < P::kCoords; ++i) p[i] = uniform(rng, -1, 1);
    if constexpr (Space<P>::kRational) {
        const double w = uniform(rng, weight_lo, 2);
        for (int i = 0; i < P::kCoords; ++i) p[i] *= w;
        p[P::kCoords - 1] = w;
    }
    return p;
}

// A clamped basis with `inner` distinct simple inner knots.
inline BSplineBasis random_clamped(std::mt19937& rng, int degree, int inner) {
    std::vector<double> t(std::size_t(degree) + 1, 0.0);
    double x = 0;
    for (int i = 0; i < inner; ++i) t.push_back(x += uniform(rng, 0.2, 1));
    x += uniform(rng, 0.2, 1);
    t.insert(t.end(), std::size_t(degree) + 1, x);
    return *BSplineBasis::make(degree, t);
}

template <std::size_t N, class P>
Patch<N, P> random_patch(std::mt19937& rng, std::array<int, N> degrees, int inner) {
    auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{random_clamped(rng, degrees[I], inner)...};
    }
    (std::make_index_sequence<N>{});
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) extent[d] = bases[d].size();
    std::vector<P> c;
    for (long long i = 0; i < count_of(extent); ++i) c.push_back(random_coefficient<P>(rng));
    return *Patch<N, P>::make(bases, Net<N, P>(extent, c));
}

// A spline over a grid, x and y even, z random: a landscape without folds.
inline Surface<Vec<3>> landscape(std::mt19937& rng, int degree, int size, double height) {
    auto basis = *BSplineBasis::clamped_uniform(degree, size);
    std::vector<Vec<3>> c;
    for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j)
            c.push_back({{double(i) / (size - 1), double(j) / (size - 1), height * uniform(rng, -1, 1)}});
    return *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({size, size}, c));
}

inline Conic<3> circle(Vec<3> centre, Vec<3> x, Vec<3> y) { return {ConicKind::ellipse, centre, x, y}; }

struct NamedSurface {
    const char* name;
    SurfaceGeometry surface;
    std::array<Interval, 2> on;  // a box to look at
};

inline std::vector<NamedSurface> surfaces_of_every_kind(unsigned seed) {
    std::mt19937 rng(seed);
    const auto spline = random_patch<2, Vec<3>>(rng, {3, 2}, 3);
    const auto nurbs = random_patch<2, Hom<3>>(rng, {2, 4}, 2);
    const auto curve = random_patch<1, Hom<3>>(rng, {3}, 3);
    const Vec<3> z{{0, 0, 1}};
    std::vector<NamedSurface> s;
    s.push_back({"plane",
                 Extrusion{Line<3>{{{1, 2, 3}}, {{1, 0, 0}}}, {{0, 0.6, 0.8}}, SurfaceKind::plane},
                 {{{-2, 3}, {-1, 4}}}});
    s.push_back({"cylinder",
                 Extrusion{circle({{1, 0, 0}}, {{2, 0, 0}}, {{0, 2, 0}}), z, SurfaceKind::cylinder},
                 {{{-1, 7}, {-1, 4}}}});
    s.push_back({"cone",
                 Revolution{Line<3>{{{2, 0, 0}}, {{0.6, 0, 0.8}}}, {}, z, SurfaceKind::cone},
                 {{{0, 6}, {-1, 4}}}});
    s.push_back({"sphere",
                 Revolution{circle({}, {{3, 0, 0}}, {{0, 0, 3}}), {}, z, SurfaceKind::sphere},
                 {{{0, 6.28}, {-1.57, 1.57}}}});
    s.push_back({"torus",
                 Revolution{circle({{5, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}), {}, z, SurfaceKind::torus},
                 {{{0, 6.28}, {0, 6.28}}}});
    s.push_back(
        {"extrusion", Extrusion{curve, {{1, 2, 0.5}}, SurfaceKind::general}, {{curve.domain()[0], {-1, 1}}}});
    s.push_back({"revolution",
                 Revolution{curve, {{3, 0, 0}}, {{0, 0.6, 0.8}}, SurfaceKind::general},
                 {{{-2, 2}, curve.domain()[0]}}});
    s.push_back(
        {"hyperboloid",
         Revolution{
             Conic<3>{ConicKind::hyperbola, {}, {{1, 0, 0}}, {{0, 0, 2}}}, {}, z, SurfaceKind::general},
         {{{0, 6}, {-1, 1.5}}}});
    s.push_back(
        {"paraboloid",
         Revolution{Conic<3>{ConicKind::parabola, {}, {{0, 0, 1}}, {{1, 0, 0}}}, {}, z, SurfaceKind::general},
         {{{0, 6}, {0.1, 1.5}}}});
    s.push_back({"bspline", spline, spline.domain()});
    s.push_back({"nurbs", nurbs, nurbs.domain()});
    s.push_back({"offset of a landscape",
                 OffsetSurface{std::make_shared<const SurfaceGeometry>(landscape(rng, 3, 6, 0.1)), 0.05},
                 {{{0, 3}, {0, 3}}}});
    s.push_back({"offset of a torus",
                 OffsetSurface{std::make_shared<const SurfaceGeometry>(Revolution{
                                   circle({{5, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}), {}, z, SurfaceKind::torus}),
                               -0.25},
                 {{{0, 6.28}, {0, 6.28}}}});
    return s;
}

// Between two half circles whose weights differ: smooth, though its homogeneous pieces are not.
inline SurfaceGeometry cone_of_uneven_weights() {
    const double w = std::sqrt(0.5);
    const double xy[5][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}};
    std::vector<Hom<3>> c;
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 2; ++k)
            c.push_back(weighted(Vec<3>{{xy[i][0] * (1 + k), xy[i][1] * (1 + k), 10.0 * k}},
                                 (i % 2 ? w : 1) * (1 + 2 * k)));
    return *Surface<Hom<3>>::make(
        {*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2}), *BSplineBasis::bezier(1)},
        Net<2, Hom<3>>({5, 2}, c));
}

// Points at equal steps of the parameters.
template <std::size_t N, class P>
std::vector<PointOf<P>> samples_of(const Patch<N, P>& patch, int steps) {
    std::vector<PointOf<P>> out;
    Index<N> extent;
    extent.fill(steps + 1);
    each_index(extent, [&](const Index<N>& i) {
        Param<N> u{};
        for (std::size_t d = 0; d < N; ++d) {
            const Interval on = patch.domain()[d];
            const double x = std::min(on.hi, on.lo + on.length() * i[d] / steps);  // not beyond by rounding
            if constexpr (N == 1)
                u = x;
            else
                u[d] = x;
        }
        out.push_back(patch.template jet<0>(u).value());
    });
    return out;
}

// n x n points a unit apart as a cubic spline of knots that are not as far apart as its points: flat, or a
// wave.
inline SurfaceGeometry rolling(int n, double height) {
    std::vector<Vec<3>> net;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            net.push_back({{double(i), double(k), height * std::sin(1.3 * i) * std::cos(1.1 * k)}});
    const auto basis = *BSplineBasis::clamped_uniform(3, n);
    return *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({n, n}, std::move(net)));
}

}  // namespace freiform::test
