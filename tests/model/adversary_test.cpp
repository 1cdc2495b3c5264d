// Surfaces and boundaries that are made to spoil a mesh, judged by `deviation`, which knows nothing of how
// meshes are made.
#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/model/deviation.hpp>

#include <cstdlib>
#include <gtest/gtest.h>
#include <support/sanitizer.hpp>

using namespace freiform;
using namespace freiform::test;

namespace {

// A flat spline with one coefficient raised and one weight changed.
struct Bump {
    int i = 5, k = 6;
    double height = 0.1, weight = 1, shift = 0;

    Bump moved(Random& rng) const {
        Bump b = *this;
        b.i = std::clamp(b.i + rng.integer(-1, 1), 1, 10);
        b.k = std::clamp(b.k + rng.integer(-1, 1), 1, 10);
        b.height *= std::exp2(rng.real(-1, 1));
        b.weight = std::clamp(b.weight * std::exp2(rng.real(-1, 1)), 1.0 / 64, 64.0);
        b.shift = std::clamp(b.shift + rng.real(-0.05, 0.05), -0.2, 0.2);
        return b;
    }
    Model model() const {
        const auto basis = *BSplineBasis::clamped_uniform(3, 12);
        std::vector<Hom<3>> c;
        for (int a = 0; a < 12; ++a)
            for (int b = 0; b < 12; ++b) {
                const bool here = a == i && b == k;
                const double w = here ? weight : 1;
                c.push_back(
                    {{w * (a / 11.0 + (here ? shift : 0)), w * b / 11.0, w * (here ? height : 0.0), w}});
            }
        ModelBuilder builder;
        EXPECT_TRUE(builder.add(*Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({12, 12}, c))));
        return *std::move(builder).finish();
    }
};

// How much of the promise is used up: measured distance / proven distance. Above 1 the proof is wrong.
double used(const Model& model, double tolerance, double& bound, std::size_t parts = 1500) {
    const auto t = tessellate(model, {.tolerance = tolerance, .max_triangles = 100'000, .progress = {}});
    if (!t) {
        EXPECT_EQ(t.error().kind, RefusalKind::limit) << t.error().message;
        return 0;
    }
    EXPECT_TRUE(t->refused.empty());
    bound = t->error_bound + t->boundary_gap;
    const auto d = deviation(model, t->mesh, {.max_parts = parts});
    EXPECT_TRUE(d);
    return d ? d->measured / bound : 0;
}

TEST(Adversary, a_search_for_the_worst_bump_does_not_break_the_bound) {
    Random rng(17);
    const double tolerance = 0.02;
    double worst = 0;
    for (int start = 0; start < (kAddressSanitizer ? 1 : 3); ++start) {
        Bump best;
        double most = 0;
        for (int step = 0; step < (kAddressSanitizer ? 6 : 10); ++step) {
            const Bump b = step == 0 ? best.moved(rng).moved(rng) : best.moved(rng);
            double bound = 0;
            const double u = used(b.model(), tolerance, bound);
            EXPECT_LE(bound, tolerance);
            EXPECT_LE(u, 1) << "height " << b.height << " weight " << b.weight << " shift " << b.shift
                            << " at " << b.i << ", " << b.k;
            if (u > most) most = u, best = b;
        }
        worst = std::max(worst, most);
    }
    EXPECT_GE(worst, 0.3) << "the bound is far too large, or nothing was searched";
}

constexpr std::size_t kFewParts = 300;  // where there are many models

// How many: FREIFORM_ADVERSARIES=1000 looks at all.
int adversaries(int usual) {
    const char* said = std::getenv("FREIFORM_ADVERSARIES");
    return said ? std::atoi(said) : cases(usual);
}

// One coefficient raised in a flat spline of 24 x 24, at every place when all are asked for.
TEST(Adversary, a_bump_is_seen_wherever_it_is) {
    const int all = 24 * 24, count = std::min(adversaries(2), all);
    const auto basis = *BSplineBasis::clamped_uniform(3, 24);
    double worst = 0;
    for (int n = 0; n < count; ++n) {
        const int at = count == all ? n : (n * 241 + 100) % all;
        std::vector<Vec<3>> c;
        for (int i = 0; i < 24; ++i)
            for (int j = 0; j < 24; ++j) c.push_back({{double(i), double(j), i * 24 + j == at ? 5.0 : 0.0}});
        ModelBuilder builder;
        ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({24, 24}, c))));
        const auto model = std::move(builder).finish();
        double bound = 0;
        const double u = used(*model, 0.2, bound, kFewParts);
        EXPECT_LE(bound, 0.2) << at;
        EXPECT_LE(u, 1) << at;
        worst = std::max(worst, u);
    }
    if (count == all) {
        EXPECT_GE(worst, 0.1) << "no bump was seen";
        std::printf("bumps: %d, largest measured / bound %.3f\n", count, worst);
    }
}

TEST(Adversary, spheres_of_any_size_keep_the_bound) {
    for (const double r : {1e6, 1e-5, 0x1p300, 0x1p-300})
        for (const Vec<3>& centre : {Vec<3>{{3 * r, -r, 2 * r}}}) {
            double bound = 0;
            EXPECT_LE(used(test::sphere(centre, r), 0.05 * r, bound, kFewParts), 1) << r;
            EXPECT_LE(bound, 0.05 * r) << r;
        }
}

// Coordinate ascent on measured / bound from random starts: each step changes one number of a small surface
// and is kept if more of the bound is used up.
struct Patchlet {
    static constexpr int kSize = 5;
    std::array<double, kSize * kSize> z{}, weight{};
    double tolerance = 0.01;

    Model model() const {
        const auto basis = *BSplineBasis::clamped_uniform(3, kSize);
        std::vector<Hom<3>> c;
        for (int i = 0; i < kSize; ++i)
            for (int k = 0; k < kSize; ++k) {
                const double w = weight[std::size_t(i * kSize + k)];
                c.push_back(
                    {{w * i / (kSize - 1.0), w * k / (kSize - 1.0), w * z[std::size_t(i * kSize + k)], w}});
            }
        ModelBuilder builder;
        EXPECT_TRUE(builder.add(*Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({kSize, kSize}, c))));
        return *std::move(builder).finish();
    }
};

TEST(Adversary, a_maximiser_does_not_break_the_bound) {
    Random rng(41);
    const int count = std::max(adversaries(4), 2), steps = 10;
    double worst = 0;
    for (int done = 0; done < count;) {
        Patchlet best;
        for (double& x : best.z) x = rng.chance(0.5) ? rng.real(-0.5, 0.5) : 0;
        for (double& w : best.weight) w = rng.chance(0.3) ? std::exp2(rng.real(-2, 2)) : 1;
        best.tolerance = std::exp2(rng.real(-5, -3));
        double most = 0;
        for (int step = 0; step < steps && done < count; ++step, ++done) {
            Patchlet p = best;
            const auto at = std::size_t(rng.integer(0, 24));
            if (step > 0) {
                if (rng.chance(0.6))
                    p.z[at] += rng.real(-0.2, 0.2);
                else if (rng.chance(0.6))
                    p.weight[at] = std::clamp(p.weight[at] * std::exp2(rng.real(-2, 2)), 0.125, 8.0);
                else
                    p.tolerance = std::clamp(p.tolerance * std::exp2(rng.real(-1, 1)), 0.01, 0.2);
            }
            double bound = 0;
            const double u = used(p.model(), p.tolerance, bound, kFewParts);
            EXPECT_LE(u, 1) << done;
            EXPECT_LE(bound, p.tolerance) << done;
            if (u > most) most = u, best = p;
        }
        worst = std::max(worst, most);
    }
    if (count >= 100) std::printf("surfaces: %d, largest measured / bound %.3f\n", count, worst);
    if (count >= 100) {
        EXPECT_GE(worst, 0.2);
    }
}

// A closed polygon around `centre` with spikes; neighbouring spikes may nearly touch.
std::vector<CurveGeometry<2>> spiky(Random& rng, Vec<2> centre, double least, double most, int corners,
                                    double& area) {
    std::vector<Vec<2>> p;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * kPi * (i + rng.real(0, 0.98)) / corners;
        const double r = rng.chance(0.5) ? rng.real(least, most) : i % 2 ? most : least;
        p.push_back(centre + r * Vec<2>{{std::cos(angle), std::sin(angle)}});
    }
    std::vector<CurveGeometry<2>> loop;
    area = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec<2>&a = p[i], &b = p[(i + 1) % p.size()];
        area += cross(a - centre, b - centre) / 2;
        loop.push_back(*Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {a, b})));
    }
    return loop;
}

TEST(Adversary, spiky_holes_leave_the_right_area_and_the_bound) {
    Random rng(18);
    for (int round = 0; round < (kAddressSanitizer ? 3 : 10); ++round) {
        std::vector<Vec<3>> c;
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 6; ++k) c.push_back({{i / 5.0, k / 5.0, 0.2 * rng.real(-1, 1)}});
        const auto basis = *BSplineBasis::clamped_uniform(3, 6);
        const auto surface = *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({6, 6}, c));
        const double w = surface.domain()[0].hi;
        double outer = 0, first = 0, second = 0;
        std::vector<std::vector<CurveGeometry<2>>> loops;
        loops.push_back(spiky(rng, {{w / 2, w / 2}}, 0.35 * w, 0.49 * w, rng.integer(5, 40), outer));
        loops.push_back(spiky(rng, {{0.4 * w, w / 2}}, 1e-6 * w, 0.09 * w, rng.integer(3, 30), first));
        loops.push_back(spiky(rng, {{0.6 * w, w / 2}}, 0.05 * w, 0.0999 * w, rng.integer(5, 30), second));
        ModelBuilder builder;
        ASSERT_TRUE(builder.add_trimmed(surface, loops)) << round;
        const auto model = std::move(builder).finish();
        ASSERT_TRUE(model) << round;
        const auto t = tessellate(*model, {.tolerance = 0.01});
        ASSERT_TRUE(t) << round;
        ASSERT_TRUE(t->refused.empty()) << round << ": " << t->refused[0].reason.message;
        double area = 0;
        for (const auto& tri : t->mesh.triangles) {
            const auto uv = [&](int k) { return t->mesh.vertices[std::size_t(tri[std::size_t(k)])].uv; };
            const double part = cross(uv(1) - uv(0), uv(2) - uv(0)) / 2;
            EXPECT_GT(part, 0) << round;
            area += part;
        }
        EXPECT_NEAR(area, outer - first - second, 1e-11 * w * w) << round;
        EXPECT_EQ(t->topology.non_manifold_edges, 0) << round;
        EXPECT_EQ(t->topology.degenerate_triangles, 0) << round;
        EXPECT_LE(t->error_bound, 0.01) << round;
        const auto d = deviation(*model, t->mesh, {.enough = 0.01, .max_parts = 4000});
        ASSERT_TRUE(d);
        EXPECT_LE(d->measured, t->error_bound + t->boundary_gap) << round;
        EXPECT_LE(d->mesh_measured, t->error_bound + t->boundary_gap + d->accuracy) << round;
    }
}

}  // namespace
