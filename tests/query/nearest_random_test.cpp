// Nearest points of many random and nasty objects: no sample of the object is nearer than the bound, and none
// nearer than the point, by more than both are rounded.
// FREIFORM_NEAREST=100000 asks that many random questions and 1,000 nasty ones.
#include <freiform/core/constants.hpp>
#include <freiform/query/nearest.hpp>

#include <cstdlib>
#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/sanitizer.hpp>
#include <support/shapes.hpp>

namespace freiform::test {
namespace {

int questions(int without, int with) {
    const char* asked = std::getenv("FREIFORM_NEAREST");
    return asked ? std::max(1, with ? with : std::atoi(asked)) : cases(without);
}

template <int D>
double separation(const Vec<D>& a, const Vec<D>& b) {  // without under- or overflow
    const Vec<D> d = a - b;
    const double scale = max_abs(d);
    return scale > 0 ? scale * norm((1 / scale) * d) : 0;
}

// `count` points within `reach`, some of them on the object.
template <std::size_t N, class P>
void ask(const Patch<N, P>& patch, Random& random, double reach, int count) {
    constexpr int D = Space<P>::kDim;
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(patch)}));
    const auto samples = samples_of(patch, N == 1 ? 300 : 24);
    for (int k = 0; k < count; ++k) {
        Vec<D> q;
        for (int d = 0; d < D; ++d) q[d] = random.real(-reach, reach);
        if (k % 7 == 0) q = samples[std::size_t(random.integer(0, int(samples.size()) - 1))];
        const auto n = must(query.template nearest<D>(q));
        double least = kInfinity;
        for (const auto& x : samples) least = std::min(least, separation<D>(x, q));
        const double rounding = 1e-14 * least + 2 * patch.value_error_bound();
        EXPECT_LE(n.distance - n.point_error, least + rounding);
        EXPECT_LE(n.lower_bound, least + rounding);
        EXPECT_LE(n.lower_bound, n.distance);
    }
}

TEST(NearestRandom, nothing_is_nearer_than_the_bound_or_the_answer) {
    Random random(20261122);
    std::mt19937 rng(77);
    constexpr int kEach = 10;
    const int count = questions(400, 0);
    for (int asked = 0, i = 0; asked < count; asked += kEach, ++i) {
        const int p = 1 + i % 5, q = 1 + i % 3, inner = i % 4;
        if (i % 6 == 0) ask(random_patch<1, Vec<2>>(rng, {p}, inner), random, 2, kEach);
        if (i % 6 == 1) ask(random_patch<1, Hom<3>>(rng, {p}, inner), random, 2, kEach);
        if (i % 6 == 2) ask(random_patch<2, Vec<3>>(rng, {p, q}, inner), random, 2, kEach);
        if (i % 6 == 3) ask(random_patch<2, Hom<3>>(rng, {q, p}, inner), random, 2, kEach);
        if (i % 6 == 4) ask(random_patch<1, Vec<3>>(rng, {p}, inner), random, 20, kEach);
        if (i % 6 == 5) ask(random_patch<2, Vec<2>>(rng, {q, q}, 0), random, 1, kEach);
        if (HasFailure()) FAIL() << "object " << i;
    }
}

// Random, each point and its weight changed by f(index, point, weight).
template <std::size_t N, class F>
Patch<N, Hom<3>> spoilt(std::mt19937& rng, std::array<int, N> degrees, int inner, F&& f) {
    const auto base = random_patch<N, Hom<3>>(rng, degrees, inner);
    std::vector<Hom<3>> net;
    for (const auto& h : base.net().flat()) {
        Vec<3> x = project(h);
        double w = 1;
        f(net.size(), x, w);
        net.push_back(weighted(x, w));
    }
    return must(Patch<N, Hom<3>>::make(base.bases(), Net<N, Hom<3>>(base.net().extent(), net)));
}

// All of a curve of parameters is as near there: without a look at the whole piece, parts have no end.
TEST(NearestRandom, a_surface_flattened_to_a_line_or_plane_is_proven_with_few_parts) {
    Random random(6);
    std::mt19937 rng(79);
    for (int i = 0; i < 40; ++i) {
        const bool line = i % 2 == 0;
        const auto s = spoilt<2>(rng, {2 + i % 3, 2}, 0, [&](std::size_t, Vec<3>& x, double&) {
            line ? x = x[0] * Vec<3>{{1, 2, 3}} : x = x[0] * Vec<3>{{1, 2, 3}} + x[1] * Vec<3>{{3, -1, 0.5}};
        });
        const auto query = must(NearestQuery::make(std::array{NearestObject::of(s)}));
        const Vec<3> inside =
            s(random.real(0.2, 0.8) * s.domain()[0].hi, random.real(0.2, 0.8) * s.domain()[1].hi);
        for (const double away : {0.1, 1.0, 30.0}) {  // across
            const Vec<3> q =
                inside + away * (line ? Vec<3>{{3, -3, 1}} : cross(Vec<3>{{1, 2, 3}}, Vec<3>{{3, -1, 0.5}}));
            const auto n = must(query.nearest<3>(q, {.max_parts = 400}));
            EXPECT_LE(n.distance - n.lower_bound, 1e-9 * (1 + away)) << i;
            EXPECT_LE(n.lower_bound, separation<3>(inside, q) + 1e-12 * (1 + away)) << i;
        }
    }
}

// Points, cusps, collapsed sides, lines run to and fro, uneven weights, tiny, huge and far away.
TEST(NearestRandom, nasty_objects_are_answered_too) {
    Random random(5);
    std::mt19937 rng(78);
    constexpr int kEach = 4;
    const int count = questions(64, 1000);
    for (int asked = 0, i = 0; asked < count; asked += 2 * kEach, ++i) {
        const int p = 2 + i % 4, kind = i % 8;
        ask(spoilt<1>(rng, {p}, i % 3,
                      [&](std::size_t k, Vec<3>& x, double& w) {
                          if (kind == 0) x = {};
                          if (kind == 1 && k % 2) x = {{1, 0, 0}};
                          if (kind == 2) w = k % 2 ? 1e8 : 1e-8;
                          if (kind == 3) x = 1e-150 * x;
                          if (kind == 4) x[0] += 1e9;
                          if (kind == 5) x[1] = x[2] = 0;
                          if (kind == 6) w = k % 2 ? 1e-6 : 1, x[2] = 0;
                          if (kind == 7) x = std::round(2 * x[0]) * Vec<3>{{1, 1, 1}};
                      }),
            random, kind == 3 ? 1e-150 : 2, kEach);
        const int other = i % 6;
        ask(spoilt<2>(rng, {p, 2}, 0,
                      [&](std::size_t k, Vec<3>& x, double& w) {
                          if (other == 0 && k < 3) x = {};
                          if (other == 1) x[2] = 0;
                          if (other == 2) w = k % 2 ? 1e5 : 1e-5;
                          if (other == 3) x = x[0] * Vec<3>{{1, 2, 3}};
                          if (other == 4) x = {{1, 1, 1}};
                          if (other == 5) x = 1e200 * x;
                      }),
            random, other == 5 ? 1e200 : 2, kEach);
        if (HasFailure()) FAIL() << "object " << i;
    }
}

}  // namespace
}  // namespace freiform::test
