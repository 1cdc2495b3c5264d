// The least distance of two objects against all pairs of many samples, and where it is known.
#include <freiform/make/conic.hpp>
#include <freiform/query/distance.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/shapes.hpp>

namespace freiform::test {
namespace {

template <class P>
P moved(const P& p, double by) {
    P out = p;
    for (int k = 0; k < Space<P>::kDim; ++k) out[k] += by * Space<P>::weight(p);
    return out;
}
// Random, its coordinates `by` more.
template <std::size_t N, class P>
Patch<N, P> patch_at(std::mt19937& rng, std::array<int, N> degrees, int inner, double by) {
    const auto patch = random_patch<N, P>(rng, degrees, inner);
    std::vector<P> c;
    for (const P& p : patch.net().flat()) c.push_back(moved(p, by));
    std::array<BSplineBasis, N> bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{patch.basis(int(I))...};
    }
    (std::make_index_sequence<N>{});
    return must(Patch<N, P>::make(bases, Net<N, P>(patch.net().extent(), c)));
}

template <std::size_t N, class P>
NearestQuery set_of(const Patch<N, P>& patch) {
    return must(NearestQuery::make(std::array{NearestObject::of(patch)}));
}
template <std::size_t N, class P>
PointOf<P> value_at(const Patch<N, P>& patch, const std::array<double, 3>& at) {
    Param<N> u{};
    if constexpr (N == 1)
        u = at[0];
    else
        for (std::size_t d = 0; d < N; ++d) u[d] = at[d];
    return patch.template jet<0>(u).value();
}

template <std::size_t N, std::size_t M, class P>
void check_pairs(unsigned seed, int trials, int steps_a, int steps_b, double width) {
    constexpr int D = Space<P>::kDim;
    std::mt19937 rng(seed);
    for (int trial = 0; trial < trials; ++trial) {
        std::array<int, N> p;
        std::array<int, M> q;
        p.fill(1 + trial % 3), q.fill(1 + (trial / 2) % 3);
        const auto a = patch_at<N, P>(rng, p, 2, 0);
        const auto b = patch_at<M, P>(rng, q, 1, trial % 3 == 0 ? 0.2 : 1.5);
        const auto d = must(least_distance<D>(set_of(a), set_of(b)));
        double least = 1e300;
        const auto sb = samples_of(b, steps_b);
        for (const auto& x : samples_of(a, steps_a))
            for (const auto& y : sb) least = std::min(least, norm(x - y));
        EXPECT_LE(d.distance, least + d.point_error) << "trial " << trial;
        EXPECT_LE(d.lower_bound, d.distance);
        EXPECT_GE(d.lower_bound, d.distance - width) << "trial " << trial;
        EXPECT_NEAR(norm(d.point[0] - d.point[1]), d.distance, 1e-14);
        EXPECT_LE(norm(value_at(a, d.at[0]) - d.point[0]), d.point_error + 1e-14);
        EXPECT_LE(norm(value_at(b, d.at[1]) - d.point[1]), d.point_error + 1e-14);
    }
}

TEST(LeastDistance, of_two_curves_is_below_that_of_all_samples) {
    check_pairs<1, 1, Hom<3>>(1, 12, 300, 300, 1e-8);
}
TEST(LeastDistance, of_a_curve_and_a_surface_is_below_that_of_all_samples) {
    check_pairs<1, 2, Hom<3>>(2, 9, 100, 40, 1e-8);
    check_pairs<2, 1, Vec<3>>(3, 6, 40, 100, 1e-8);
}
TEST(LeastDistance, of_two_surfaces_is_below_that_of_all_samples) {
    check_pairs<2, 2, Hom<3>>(4, 6, 24, 24, 1e-8);
}

TEST(LeastDistance, of_circles_and_lines_is_what_it_is) {
    const auto ring = [](double x, double y, double r) {
        return must(full_ellipse(must(circle(Vec<2>{{x, y}}, r)), EllipseForm::closed)).curve;
    };
    const auto apart = must(least_distance<2>(set_of(ring(0, 0, 1)), set_of(ring(3, 4, 2))));
    EXPECT_NEAR(apart.distance, 2, 1e-14);
    EXPECT_GE(apart.lower_bound, 2 - 1e-8);
    const auto crossing = must(least_distance<2>(set_of(ring(0, 0, 1)), set_of(ring(1, 0, 1))));
    EXPECT_LE(crossing.distance, 1e-15);
    EXPECT_EQ(crossing.lower_bound, 0);
    const auto inside = must(least_distance<2>(set_of(ring(0, 0, 1)), set_of(ring(0.25, 0, 3))));
    EXPECT_NEAR(inside.distance, 1.75, 1e-14);
    const auto line = [](const Vec<2>& p, const Vec<2>& q) {
        return must(Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {p, q})));
    };
    const auto ends =
        must(least_distance<2>(set_of(line({{0, 0}}, {{1, 0}})), set_of(line({{4, 4}}, {{9, 7}}))));
    EXPECT_EQ(ends.distance, 5);
    EXPECT_EQ(ends.at[0][0], 1);
    EXPECT_EQ(ends.at[1][0], 0);
    // Of parallel lines all are as near: the budget ends it, or the accuracy, and the bound holds.
    const auto parallel = must(least_distance<2>(set_of(line({{0, 0}}, {{1, 0}})),
                                                 set_of(line({{0, 2}}, {{1, 2}})), {.max_pairs = 50}));
    EXPECT_EQ(parallel.distance, 2);
    EXPECT_GE(parallel.lower_bound, 2 - 1e-8);
}

TEST(LeastDistance, scales_exactly_and_says_which_objects) {
    std::mt19937 rng(9);
    const auto a = patch_at<1, Vec<3>>(rng, {3}, 3, 0);
    const auto near = patch_at<1, Vec<3>>(rng, {3}, 3, 2), far = patch_at<1, Vec<3>>(rng, {2}, 1, 9);
    const auto both = must(NearestQuery::make(std::array{NearestObject::of(far), NearestObject::of(near)}));
    const auto d = must(least_distance<3>(set_of(a), both));
    EXPECT_EQ(d.object[1], 1u);
    EXPECT_DOUBLE_EQ(d.distance, must(least_distance<3>(set_of(a), set_of(near))).distance);
    const auto turned = must(least_distance<3>(both, set_of(a)));
    EXPECT_NEAR(turned.distance, d.distance, 1e-14);
    EXPECT_EQ(turned.object[0], 1u);
    for (const double scale : {0x1p-400, 0x1p300}) {
        const auto scaled = [&](const Curve<Vec<3>>& c) {
            std::vector<Vec<3>> points;
            for (const Vec<3>& p : c.net().flat()) points.push_back(scale * p);
            return must(Curve<Vec<3>>::make({c.basis()}, Net<1, Vec<3>>(c.net().extent(), points)));
        };
        const auto s = must(least_distance<3>(set_of(scaled(a)), set_of(scaled(near))));
        const auto one = must(least_distance<3>(set_of(a), set_of(near)));
        EXPECT_EQ(s.distance, scale * one.distance);
        EXPECT_EQ(s.lower_bound, scale * one.lower_bound);
        EXPECT_EQ(s.at, one.at);
    }
}

// Boxes and hulls of these parts are as far apart as the objects, and a small budget ends before points are
// found that are as near: a bound that is too large by any per cent is seen.
TEST(LeastDistance, bounds_that_are_exactly_the_distance_are_not_exceeded_before_it_is_found) {
    const auto run = [](double angle, double gap) {
        const auto comb = [&](double from, double to, double y) {
            std::vector<Vec<2>> points;
            std::vector<double> knots{0};
            for (int i = 0; i <= 40; ++i) {
                const double x = from + (to - from) * i / 40;
                points.push_back(
                    {{x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle)}});
                knots.push_back(i);
            }
            knots.push_back(40);
            return must(
                Curve<Vec<2>>::make({must(BSplineBasis::make(1, knots))}, Net<1, Vec<2>>({41}, points)));
        };
        const auto a = set_of(comb(-30, 0, 0)), b = set_of(comb(gap + 50, gap, 0));
        double loosest = 0;
        for (int pairs = 1; pairs <= 60; ++pairs) {
            const auto d = must(least_distance<2>(a, b, {.max_pairs = pairs}));
            EXPECT_LE(d.lower_bound, gap * (1 + 1e-12)) << angle << " " << pairs;
            if (d.lower_bound >= 0.999 * gap) loosest = std::max(loosest, d.distance);
        }
        return loosest / gap;  // of the points known when the bound was all there is to know
    };
    for (const double gap : {2.0, 0.3}) {
        EXPECT_GE(run(0, gap), 1.01);
        EXPECT_GE(run(0.6, gap), 1.01);
    }
}

TEST(LeastDistance, a_spent_budget_leaves_a_bound_that_holds_and_nonsense_is_refused) {
    std::mt19937 rng(10);
    const auto a = patch_at<2, Vec<3>>(rng, {2, 2}, 2, 0), b = patch_at<2, Vec<3>>(rng, {2, 2}, 2, 1.2);
    const auto all = must(least_distance<3>(set_of(a), set_of(b)));
    double before = -1;
    for (const int pairs : {1, 10, 100, 1000}) {
        const auto some = must(least_distance<3>(set_of(a), set_of(b), {.max_pairs = pairs}));
        EXPECT_LE(some.lower_bound, all.distance);
        EXPECT_GE(some.lower_bound, before);
        before = some.lower_bound;
        EXPECT_TRUE(std::isfinite(some.distance)) << pairs;
    }
    const auto plane = patch_at<1, Vec<2>>(rng, {1}, 0, 0);
    expect_refusal(least_distance<3>(set_of(a), set_of(plane)), RefusalKind::invalid, "objects");
    expect_refusal(least_distance<3>(set_of(a), set_of(b), {.accuracy = -1}), RefusalKind::invalid,
                   "accuracy");
    expect_refusal(least_distance<3>(set_of(a), set_of(b), {.max_pairs = 0}), RefusalKind::invalid,
                   "max_pairs");
}

}  // namespace
}  // namespace freiform::test
