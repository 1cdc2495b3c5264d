// Surfaces and boundaries that are made to spoil a mesh, judged by `deviation`, which knows nothing of how
// meshes are made.
#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/model/deviation.hpp>

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
double used(const Model& model, double tolerance, double& bound) {
    const auto t = tessellate(model, {.tolerance = tolerance, .max_triangles = 100'000, .progress = {}});
    if (!t) {
        EXPECT_EQ(t.error().kind, RefusalKind::limit) << t.error().message;
        return 0;
    }
    EXPECT_TRUE(t->refused.empty());
    bound = t->error_bound + t->boundary_gap;
    const auto d = deviation(model, t->mesh, {.max_parts = 1500});
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
        for (int step = 0; step < (kAddressSanitizer ? 4 : 10); ++step) {
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
