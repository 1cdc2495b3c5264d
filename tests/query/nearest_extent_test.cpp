// The farthest point and all points within a radius, against many samples; what is as near as the nearest.
#include <freiform/make/conic.hpp>
#include <freiform/query/nearest.hpp>

#include <algorithm>
#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/shapes.hpp>

namespace freiform::test {
namespace {

Vec<3> point_within(Random& random, double reach) {
    return {{random.real(-reach, reach), random.real(-reach, reach), random.real(-reach, reach)}};
}

NearestQuery query_of(const auto& patch) {
    return must(NearestQuery::make(std::array{NearestObject::of(patch)}));
}

Curve<Hom<2>> ring_of(double x, double y, double radius) {
    return must(full_ellipse(must(circle(Vec<2>{{x, y}}, radius)), EllipseForm::closed)).curve;
}

// f(parameters as three numbers, point) for many places.
template <std::size_t N, class P>
void each_sample(const Patch<N, P>& patch, int steps, auto&& f) {
    Index<N> extent;
    extent.fill(steps + 1);
    each_index(extent, [&](const Index<N>& i) {
        Param<N> u{};
        std::array<double, 3> at{};
        for (std::size_t d = 0; d < N; ++d) {
            const Interval on = patch.domain()[d];
            at[d] = i[d] == steps ? on.hi : on.lo + on.length() * i[d] / steps;
            if constexpr (N == 1)
                u = at[0];
            else
                u[d] = at[d];
        }
        f(at, patch.template jet<0>(u).value());
    });
}

template <std::size_t N, class P>
void check_extent(int seed) {
    std::mt19937 rng(unsigned(seed) + unsigned(N));
    Random random(unsigned(seed) + 1);
    for (int trial = 0; trial < 4; ++trial) {
        std::array<int, N> degrees;
        degrees.fill(1 + trial % 3);
        const auto patch = random_patch<N, P>(rng, degrees, N == 3 ? 1 : 3);
        const auto query = query_of(patch);
        for (int k = 0; k < 6; ++k) {
            const Vec<3> q = point_within(random, 2);
            const auto far = must(query.template farthest<3>(q));
            EXPECT_LE(far.upper_bound - far.distance, 1e-7) << "not proven";
            EXPECT_GE(far.upper_bound, far.distance);
            const double radius = random.real(0.2, 1.5);
            const auto near = must(query.template within<3>(q, radius, N == 3 ? 0.125 : 0x1p-5));
            EXPECT_TRUE(near.complete);
            const double slack = patch.value_error_bound();
            each_sample(patch,
                        N == 1   ? 300
                        : N == 2 ? 24
                                 : 8,
                        [&](const auto& at, const Vec<3>& x) {
                            const double d = norm(x - q);
                            EXPECT_LE(d, far.upper_bound + slack);
                            if (d >= radius - slack) return;
                            bool covered = false;
                            for (const auto& r : near.regions) {
                                bool in = true;
                                for (std::size_t e = 0; e < N; ++e) in = in && r.box[e].contains(at[e]);
                                covered = covered || in;
                            }
                            EXPECT_TRUE(covered) << d << " of " << radius;
                        });
            double last = 0;
            for (const auto& r : near.regions) {
                EXPECT_GE(r.distance, last);
                EXPECT_NEAR(norm(r.point - q), r.distance, 1e-14);
                last = r.distance;
                for (std::size_t e = 0; e < N; ++e) EXPECT_TRUE(r.box[e].contains(r.at[e]));
            }
        }
    }
}

TEST(NearestExtent, farthest_and_within_agree_with_samples_of_curves) { check_extent<1, Hom<3>>(3); }
TEST(NearestExtent, farthest_and_within_agree_with_samples_of_surfaces) { check_extent<2, Hom<3>>(5); }
TEST(NearestExtent, farthest_and_within_agree_with_samples_of_volumes) { check_extent<3, Vec<3>>(7); }

TEST(NearestExtent, farthest_point_of_a_circle_is_opposite_and_from_the_centre_all_are) {
    const auto query = query_of(ring_of(1, 2, 3));
    const auto far = must(query.farthest<2>(Vec<2>{{5, 2}}));
    EXPECT_NEAR(far.distance, 7, 1e-14);
    EXPECT_NEAR(far.upper_bound, 7, 1e-11);
    EXPECT_NEAR(far.point[0], -2, 1e-7);
    const auto centre = must(query.farthest<2>(Vec<2>{{1, 2}}));
    EXPECT_NEAR(centre.distance, 3, 1e-14);
    EXPECT_NEAR(centre.upper_bound, 3, 1e-11);
    const auto beyond = must(query.farthest<2>(Vec<2>{{1e300, 0}}));
    EXPECT_GE(beyond.upper_bound, 1e300);
    EXPECT_LE(beyond.upper_bound, 4e300);
}

TEST(NearestExtent, from_the_centre_of_a_circle_all_of_it_is_as_near) {
    const auto query = query_of(ring_of(1, 2, 3));
    const Vec<2> q{{1, 2}};
    const auto many = must(query.as_near<2>(q, must(query.nearest<2>(q))));
    ASSERT_EQ(many.regions.size(), 1u);
    EXPECT_TRUE(many.regions[0].stretch);
    const auto on = must(query.within<2>(q, 100));  // the domain of the curve is all that there is
    EXPECT_EQ(many.regions[0].box[0], on.regions[0].box[0]);

    const Vec<2> beside{{1.5, 2}};
    const auto one = must(query.as_near<2>(beside, must(query.nearest<2>(beside))));
    EXPECT_TRUE(one.complete);
    EXPECT_FALSE(one.regions[0].stretch);
    EXPECT_LT(one.regions[0].box[0].length(), 1e-6);
}

TEST(NearestExtent, two_feet_at_the_same_distance_are_both_said) {
    const auto parabola = must(Curve<Vec<2>>::make({*BSplineBasis::bezier(2)},
                                                   Net<1, Vec<2>>({3}, {{{-2, 4}}, {{0, -4}}, {{2, 4}}})));
    const auto query = query_of(parabola);  // y = x^2
    const Vec<2> q{{0, 2}};                 // feet at x^2 = 3/2
    const auto both = must(query.as_near<2>(q, must(query.nearest<2>(q))));
    ASSERT_EQ(both.regions.size(), 2u);
    for (const auto& r : both.regions) {
        EXPECT_NEAR(std::abs(r.point[0]), std::sqrt(1.5), 1e-6);
        EXPECT_NEAR(r.distance, std::sqrt(1.75), 1e-13);
        EXPECT_FALSE(r.stretch);
    }
    EXPECT_LT(both.regions[0].point[0] * both.regions[1].point[0], 0);
    const auto line =
        must(Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{1, 0}}})));
    const auto two = must(NearestQuery::make(std::array{NearestObject::of(line), NearestObject::of(line)}));
    const Vec<2> above{{0.5, 1}};
    EXPECT_EQ(must(two.as_near<2>(above, must(two.nearest<2>(above)))).regions.size(), 2u);
}

// A trough has two feet at the same first parameter: what touches in one parameter alone is not one region.
TEST(NearestExtent, feet_that_differ_in_the_second_parameter_are_two) {
    std::vector<Vec<3>> net;
    for (const double x : {-1.0, 1.0})
        for (const Vec<2>& p : {Vec<2>{{-2, 4}}, Vec<2>{{0, -4}}, Vec<2>{{2, 4}}})
            net.push_back({{x, p[0], p[1]}});
    const auto trough = must(Surface<Vec<3>>::make({*BSplineBasis::bezier(1), *BSplineBasis::bezier(2)},
                                                   Net<2, Vec<3>>({2, 3}, net)));  // z = y^2
    const auto query = query_of(trough);
    const Vec<3> q{{0.25, 0, 2}};
    for (const auto& both : {must(query.as_near<3>(q, must(query.nearest<3>(q)))),
                             must(query.within<3>(q, std::sqrt(1.75) + 1e-6))}) {
        ASSERT_EQ(both.regions.size(), 2u);
        for (const auto& r : both.regions) {
            EXPECT_NEAR(std::abs(r.point[1]), std::sqrt(1.5), 1e-6);
            EXPECT_NEAR(r.distance, std::sqrt(1.75), 1e-13);
            EXPECT_TRUE(r.box[0].contains(0.625));
        }
        EXPECT_LT(both.regions[0].point[1] * both.regions[1].point[1], 0);
    }
}

TEST(NearestExtent, scales_exactly_with_powers_of_two) {
    std::mt19937 rng(9);
    Random random(10);
    const auto patch = random_patch<2, Vec<3>>(rng, {3, 2}, 3);
    const auto query = query_of(patch);
    for (const int e : {200, -200}) {
        auto net = patch.net();
        for (auto& p : net.flat())
            for (int k = 0; k < 3; ++k) p[k] = std::scalbn(p[k], e);
        const auto scaled = query_of(must(Surface<Vec<3>>::make(patch.bases(), net)));
        for (int k = 0; k < 4; ++k) {
            const Vec<3> q = point_within(random, 2);
            Vec<3> there;
            for (int i = 0; i < 3; ++i) there[i] = std::scalbn(q[i], e);
            const auto a = must(query.farthest<3>(q)), b = must(scaled.farthest<3>(there));
            EXPECT_EQ(a.at, b.at);
            EXPECT_EQ(std::scalbn(a.upper_bound, e), b.upper_bound);
            const auto c = must(query.within<3>(q, 1)),
                       d = must(scaled.within<3>(there, std::scalbn(1.0, e)));
            ASSERT_EQ(c.regions.size(), d.regions.size());
            for (std::size_t i = 0; i < c.regions.size(); ++i) EXPECT_EQ(c.regions[i].box, d.regions[i].box);
        }
    }
}

TEST(NearestExtent, a_spent_budget_is_said_and_what_is_proven_holds) {
    std::mt19937 rng(13);
    Random random(14);
    int open = 0, beaten = 0;
    for (int trial = 0; trial < 6; ++trial) {
        const auto patch = random_patch<2, Hom<3>>(rng, {3, 3}, 3);
        const auto query = query_of(patch);
        const Vec<3> q = point_within(random, 0.5);
        const double radius = must(query.nearest<3>(q)).distance + 0.3;
        const auto whole = must(query.within<3>(q, radius));
        EXPECT_TRUE(whole.complete);
        const double most = must(query.farthest<3>(q)).distance;
        for (const int budget : {1, 2, 4, 8, 16}) {
            const auto few = must(query.within<3>(q, radius, 0x1p-5, {.max_parts = budget}));
            EXPECT_FALSE(few.complete) << budget;
            const auto covered = [&](const std::array<double, 3>& at) {
                return std::ranges::any_of(few.regions, [&](const NearRegion<3>& r) {
                    return r.box[0].contains(at[0]) && r.box[1].contains(at[1]);
                });
            };
            for (const auto& r : whole.regions)
                if (r.distance < radius - 1e-12) EXPECT_TRUE(covered(r.at));
            each_sample(patch, 24, [&](const auto& at, const Vec<3>& x) {
                if (norm(x - q) <= radius - 1e-12) EXPECT_TRUE(covered(at));
            });
            const auto far = must(query.farthest<3>(q, {.max_parts = budget}));
            EXPECT_GE(far.upper_bound, most) << budget;
            EXPECT_LE(far.distance, most + 1e-7);
            open += far.upper_bound > most + 1e-3;
            beaten += far.distance < most - 1e-12;
        }
    }
    EXPECT_GT(open, 0) << "the budgets are no test";
    EXPECT_GT(beaten, 0) << "the farthest point was seen at once";
}

// Where weights are small, what the coefficients prove of a part that was not looked at is divided by them.
TEST(NearestExtent, a_spent_budget_knows_how_light_a_rational_piece_is) {
    const auto object = [](const std::array<double, 5>& y, const std::array<double, 5>& w) {
        std::vector<Hom<2>> net;
        for (std::size_t i = 0; i < 5; ++i) net.push_back(weighted(Vec<2>{{0, y[i]}}, w[i]));
        return NearestObject::of(
            must(Curve<Hom<2>>::make({*BSplineBasis::bezier(4)}, Net<1, Hom<2>>({5}, net))));
    };
    // One with a farther box, which is looked at first and takes the budget, and one with farther points.
    const auto query = must(NearestQuery::make(std::array{
        object({0, 0, 30, 0, 0}, {1, 1, 0.01, 1, 1}), object({0, 20, 20, 20, 0}, {1, 0.05, 0.05, 0.05, 1})}));
    const double most = 0.875 / (0.125 + 0.05 * 0.875);  // at 1/2
    const auto all = must(query.farthest<2>(Vec<2>{}));
    EXPECT_NEAR(all.distance, most, 1e-13);
    EXPECT_NEAR(all.upper_bound, most, 1e-9);
    EXPECT_EQ(all.object, 1u);
    const auto few = must(query.farthest<2>(Vec<2>{}, {.max_parts = 1}));
    EXPECT_LT(few.distance, most - 1) << "the budget is no test";
    EXPECT_GE(few.upper_bound, most);
}

TEST(NearestExtent, refuses_nonsense) {
    const auto query = query_of(ring_of(0, 0, 1));
    const double nan = std::nan("");
    EXPECT_EQ(query.farthest<2>(Vec<2>{{nan, 0}}).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(query.within<2>(Vec<2>{{INFINITY, 0}}, 1).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(query.within<2>(Vec<2>{{0, 0}}, -1).error().where, "radius");
    EXPECT_EQ(query.within<2>(Vec<2>{{0, 0}}, nan).error().where, "radius");
    EXPECT_EQ(query.within<2>(Vec<2>{{0, 0}}, 1, 2).error().where, "finest");
    EXPECT_TRUE(must(query.within<2>(Vec<2>{{3, 0}}, 1)).regions.empty());
}

}  // namespace
}  // namespace freiform::test
