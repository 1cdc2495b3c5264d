// Nearest points against many samples of the objects, their proofs, and what is known of circles, spheres and
// planes.
#include "query/nearest_form_detail.hpp"
#include "query/nearest_local_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/query/nearest.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/shapes.hpp>

namespace freiform::test {
namespace {

template <int D>
Vec<D> random_point(Random& random, double reach) {
    Vec<D> p;
    for (int k = 0; k < D; ++k) p[k] = random.real(-reach, reach);
    return p;
}

// The least distance to samples of the patch: a slow twin that errs on the far side only.
template <std::size_t N, class P>
double sampled_distance(const Patch<N, P>& patch, const PointOf<P>& q, int steps) {
    double least = 1e300;
    for (const auto& x : samples_of(patch, steps)) least = std::min(least, norm(x - q));
    return least;
}

// What every answer must be: on the object, as far as it says, not farther than any sample, and proven.
template <std::size_t N, class P>
void expect_nearest(const Patch<N, P>& patch, const PointOf<P>& q, const Nearest<Space<P>::kDim>& n,
                    int steps, double accuracy) {
    Param<N> u{};
    if constexpr (N == 1)
        u = n.at[0];
    else
        for (std::size_t d = 0; d < N; ++d) u[d] = n.at[d];
    const auto there = patch.template jet<0>(u).value();
    EXPECT_LE(norm(there - n.point), n.point_error + patch.value_error_bound() + 1e-14);
    EXPECT_LE(std::abs(norm(n.point - q) - n.distance), 1e-15 * (n.distance + 1));
    const double sampled = sampled_distance(patch, q, steps);
    EXPECT_LE(n.lower_bound, sampled + patch.value_error_bound());
    EXPECT_LE(n.distance - n.point_error, sampled + patch.value_error_bound());
    EXPECT_LE(n.lower_bound, n.distance);
    EXPECT_GE(n.lower_bound, n.distance - accuracy) << "not proven: " << n.distance;
}

Curve<Hom<2>> unit_circle() {
    return must(full_ellipse(must(circle(Vec<2>{{0, 0}}, 1.0)), EllipseForm::closed)).curve;
}

template <class T>
struct NearestLaws : testing::Test {};
template <std::size_t Params, class Coefficients>
struct Kind {
    static constexpr std::size_t N = Params;
    using P = Coefficients;
};
using NearestKinds = testing::Types<Kind<1, Vec<1>>, Kind<1, Vec<2>>, Kind<1, Hom<2>>, Kind<1, Vec<3>>,
                                    Kind<1, Hom<3>>, Kind<1, Hom<4>>, Kind<2, Vec<2>>, Kind<2, Vec<3>>,
                                    Kind<2, Hom<3>>, Kind<2, Vec<4>>, Kind<3, Vec<3>>, Kind<3, Hom<3>>>;
TYPED_TEST_SUITE(NearestLaws, NearestKinds);

TYPED_TEST(NearestLaws, nothing_beats_the_answer_and_the_lower_bound_proves_it) {
    constexpr std::size_t N = TypeParam::N;
    using P = typename TypeParam::P;
    constexpr int D = Space<P>::kDim;
    std::mt19937 rng(7 + unsigned(N) * 10 + unsigned(D));
    Random random(3);
    for (int trial = 0; trial < (N == 1 ? 12 : N == 2 ? 5 : 2); ++trial) {
        std::array<int, N> degrees;
        for (std::size_t d = 0; d < N; ++d) degrees[d] = 1 + (trial + int(d)) % (N == 3 ? 2 : 4);
        const auto patch = random_patch<N, P>(rng, degrees, N == 3 ? 1 : 3);
        const auto query = must(NearestQuery::make(std::array{NearestObject::of(patch)}));
        for (int k = 0; k < (N == 1 ? 40 : N == 2 ? 12 : 4); ++k) {
            const auto q = random_point<D>(random, k % 3 == 0 ? 0.5 : 2.5);
            const auto n = must(query.template nearest<D>(q));
            expect_nearest(patch, q, n, N == 1 ? 400 : N == 2 ? 40 : 10, 1e-7);
        }
    }
}

TEST(Nearest, to_a_circle_is_along_the_radius_and_from_its_centre_all_are_as_near) {
    const auto ring = must(full_ellipse(must(circle(Vec<2>{{1, 2}}, 3.0)), EllipseForm::closed)).curve;
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(ring)}));
    for (const Vec<2>& q : {Vec<2>{{5, 2}}, Vec<2>{{1, 2.5}}, Vec<2>{{-7, 9}}, Vec<2>{{1, 2 + 1e-9}}}) {
        const auto n = must(query.nearest<2>(q));
        EXPECT_NEAR(n.distance, std::abs(norm(q - Vec<2>{{1, 2}}) - 3), 1e-14);
        EXPECT_NEAR(n.lower_bound, n.distance, 1e-11);
    }
    const auto centre = must(query.nearest<2>(Vec<2>{{1, 2}}));
    EXPECT_NEAR(centre.distance, 3, 1e-14);
    EXPECT_NEAR(centre.lower_bound, 3, 1e-11);
}

TEST(Nearest, to_a_plane_patch_is_the_foot_an_edge_or_a_corner) {
    const auto b = *BSplineBasis::bezier(1);
    const auto plane = must(Surface<Vec<3>>::make(
        {b, b}, Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 4, 0}}, {{2, 0, 0}}, {{2, 4, 0}}})));
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(plane)}));
    const auto foot = must(query.nearest<3>(Vec<3>{{0.5, 1, 3}}));
    EXPECT_DOUBLE_EQ(foot.distance, 3);
    EXPECT_DOUBLE_EQ(foot.at[0], 0.25);
    EXPECT_DOUBLE_EQ(foot.at[1], 0.25);
    EXPECT_DOUBLE_EQ(must(query.nearest<3>(Vec<3>{{-3, 1, 4}})).distance, 5);
    const auto corner = must(query.nearest<3>(Vec<3>{{3, 6, 2}}));
    EXPECT_DOUBLE_EQ(corner.distance, 3);
    EXPECT_EQ(corner.at[0], 1);
    EXPECT_EQ(corner.at[1], 1);
    const auto on_it = must(query.nearest<3>(Vec<3>{{1, 1, 0}}));
    EXPECT_LE(on_it.distance, 1e-15);
    EXPECT_EQ(on_it.lower_bound, 0);
}

TEST(Nearest, of_several_objects_says_which_and_a_triangle_has_its_own_parameters) {
    const auto line = [](double y) {
        return must(
            Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {{{0, y}}, {{1, y}}})));
    };
    const std::array objects{NearestObject::of(line(0)), NearestObject::of(line(1)),
                             NearestObject::of(line(5))};
    const auto query = must(NearestQuery::make(objects));
    EXPECT_EQ(must(query.nearest<2>(Vec<2>{{0.5, 0.7}})).object, 1u);
    EXPECT_EQ(must(query.nearest<2>(Vec<2>{{0.5, 0.2}})).object, 0u);
    EXPECT_EQ(must(query.nearest<2>(Vec<2>{{0.5, 77}})).object, 2u);

    Random random(5);
    for (int degree : {1, 2, 4}) {
        std::vector<Hom<3>> c;
        for (int i = 0; i < (degree + 1) * (degree + 2) / 2; ++i)
            c.push_back(weighted(random_point<3>(random, 1), random.real(0.5, 2)));
        const auto triangle = must(SimplexPatch<2, Hom<3>>::make(degree, c));
        const auto ask = must(NearestQuery::make(std::array{NearestObject::of(triangle)}));
        for (int k = 0; k < 20; ++k) {
            const auto q = random_point<3>(random, 2);
            const auto n = must(ask.nearest<3>(q));
            const Param<2> u{n.at[0], n.at[1]};
            EXPECT_LE(norm(triangle(u) - n.point), 1e-13);
            double sampled = 1e300;
            for (int i = 0; i <= 40; ++i)
                for (int j = 0; i + j <= 40; ++j)
                    sampled = std::min(sampled, norm(triangle(i / 40.0, j / 40.0) - q));
            EXPECT_LE(n.distance, sampled + 1e-13);
            EXPECT_LE(n.lower_bound, sampled);
            EXPECT_GE(n.lower_bound, n.distance - 1e-7);
        }
    }
}

TEST(Nearest, scaling_by_powers_of_two_scales_the_answer_and_changes_nothing_else) {
    std::mt19937 rng(11);
    Random random(12);
    const auto patch = random_patch<2, Hom<3>>(rng, {3, 2}, 2);
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(patch)}));
    for (const int e : {-540, -200, -1, 37, 200, 540}) {
        Net<2, Hom<3>> net = patch.net();
        for (Hom<3>& c : net.flat())
            for (int k = 0; k < 3; ++k) c[k] = std::scalbn(c[k], e);
        const auto scaled = must(Surface<Hom<3>>::make(patch.bases(), net));
        const auto ask = must(NearestQuery::make(std::array{NearestObject::of(scaled)}));
        for (int k = 0; k < 10; ++k) {
            const auto q = random_point<3>(random, 2);
            Vec<3> far = q;
            for (int i = 0; i < 3; ++i) far[i] = std::scalbn(q[i], e);
            const auto a = must(query.nearest<3>(q)), b = must(ask.nearest<3>(far));
            EXPECT_EQ(a.at, b.at);
            EXPECT_EQ(std::scalbn(a.distance, e), b.distance);
            EXPECT_EQ(std::scalbn(a.lower_bound, e), b.lower_bound);
        }
    }
}

TEST(Nearest, points_far_beyond_the_objects_and_tiny_objects_have_honest_bounds) {
    const auto ring = unit_circle();
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(ring)}));
    for (const double x : {1e20, 1e150, 1e300}) {
        const auto n = must(query.nearest<2>(Vec<2>{{x, 0}}));
        EXPECT_NEAR(n.distance / x, 1, 1e-14);
        EXPECT_LE(n.lower_bound, n.distance);
        EXPECT_GE(n.lower_bound, 0.49 * x);
    }
    const auto dot = must(Curve<Vec<2>>::make({*BSplineBasis::bezier(3)},
                                              Net<1, Vec<2>>({4}, {{{2, 1}}, {{2, 1}}, {{2, 1}}, {{2, 1}}})));
    const auto n =
        must(must(NearestQuery::make(std::array{NearestObject::of(dot)})).nearest<2>(Vec<2>{{5, 5}}));
    EXPECT_DOUBLE_EQ(n.distance, 5);
    EXPECT_NEAR(n.lower_bound, 5, 1e-13);
}

TEST(Nearest, coordinates_below_the_normal_range_keep_the_point_found_among_all_that_are_as_near) {
    const double tiny = std::numeric_limits<double>::denorm_min();
    const auto curve = must(Curve<Vec<2>>::make(
        {*BSplineBasis::bezier(3)},
        Net<1, Vec<2>>({4}, {{{0, 0}}, {{tiny, 2 * tiny}}, {{3 * tiny, 2 * tiny}}, {{4 * tiny, 0}}})));
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(curve)}));
    const Vec<2> from{{tiny, tiny}};
    const auto n = must(query.nearest<2>(from));
    EXPECT_LE(n.distance - n.point_error, tiny);  // the true distance is 0.16 of tiny
    EXPECT_EQ(n.lower_bound, 0);
    EXPECT_FALSE(must(query.as_near<2>(from, n)).regions.empty());
}

// A strip folded along u = 1/2, and points on the crease, beside it, and above the image.
TEST(Nearest, points_at_a_fold_are_found_and_the_bound_is_as_good_as_points_are) {
    const std::vector<Vec<3>> net{{{0.25, 0, 0}},  {{0.25, 1, 0}}, {{-0.25, 0, 0}},
                                  {{-0.25, 1, 0}}, {{0.25, 0, 0}}, {{0.25, 1, 0}}};  // ((u - 1/2)^2, v, 0)
    const auto fold = must(Surface<Vec<3>>::make({*BSplineBasis::bezier(2), *BSplineBasis::bezier(1)},
                                                 Net<2, Vec<3>>({3, 2}, net)));
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(fold)}));
    for (const double beside : {0.0, 1e-15, 1e-12, 1e-8, 1e-5, 0.01})
        for (const double above : {0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3}) {
            const auto n = must(query.nearest<3>(Vec<3>{{beside, 0.3, above}}));
            EXPECT_NEAR(n.distance, above, n.point_error) << beside;
            EXPECT_NEAR(n.lower_bound, above, 8 * n.point_error) << beside << " " << above;
        }
}

// Weights of 1e-5 and 1e5 in turns: near a corner all happens in 1e-10 of the parameters, and
// between the corners in curved valleys.
TEST(Nearest, uneven_weights_leave_a_bound_that_is_as_good_as_points_are) {
    Random random(31);
    std::vector<Hom<3>> net;
    for (int i = 0; i < 9; ++i) net.push_back(weighted(random_point<3>(random, 1), i % 2 ? 1e5 : 1e-5));
    const auto b = *BSplineBasis::bezier(2);
    const auto patch = must(Surface<Hom<3>>::make({b, b}, Net<2, Hom<3>>({3, 3}, net)));
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(patch)}));
    for (int k = 0; k < 20; ++k) {
        const auto n = must(query.nearest<3>(random_point<3>(random, 2), {.max_parts = 100000}));
        EXPECT_NEAR(n.lower_bound, n.distance, 1e-9 * n.distance + 8 * n.point_error);
    }
}

TEST(Nearest, a_backstop_leaves_a_lower_bound_that_holds) {
    std::mt19937 rng(21);
    Random random(22);
    const auto patch = random_patch<2, Vec<3>>(rng, {3, 3}, 4);
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(patch)}));
    for (int k = 0; k < 30; ++k) {
        const auto q = random_point<3>(random, 1);
        const auto few = must(query.nearest<3>(q, {.max_parts = 1})), all = must(query.nearest<3>(q));
        EXPECT_LE(few.lower_bound, all.distance + 1e-14);
        EXPECT_GE(few.distance, all.lower_bound);
    }
}

// u^2 + v^2 - c u v, as a polynomial of degree 2 by 2: convex for |c| < 2, a saddle beyond.
TEST(NearestForm, is_convex_only_with_its_mixed_derivative) {
    for (const double c : {0.0, 1.0, -1.5, 1.9, 2.1, -2.5, 3.0}) {
        const double square[] = {0, 0, 1};
        std::vector<double> f;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) f.push_back(square[i] + square[j] - c * i * j / 4);
        const detail::NearestForm form{2, {1, 1, 0}, 9, f.data()};
        EXPECT_EQ(form.convex(1e-15), std::abs(c) < 2) << c;
        if (std::abs(c) < 2) {
            const double low = form.below_tangent({0.5, 0.5}, 1e-15);
            for (double u = 0; u <= 1; u += 0.125)
                for (double v = 0; v <= 1; v += 0.125) EXPECT_GE(u * u + v * v - c * u * v, low);
            EXPECT_GE(low, -1);
        }
    }
}

// At the ends and in the middle of a part: F there in more digits than doubles have.
TEST(NearestForm, made_anew_on_a_part_is_right_to_the_error_that_it_says) {
    Random random(41);
    for (int trial = 0; trial < 2000; ++trial) {
        detail::NearestTree::Piece piece;
        piece.degree = {1 + trial % 5, 0, 0};
        std::vector<double> net;
        for (std::size_t i = 0; i < piece.control_points(); ++i) {
            const double w = std::exp2(random.real(-20, 0));
            net.insert(net.end(), {w * random.real(-1, 1), w * random.real(-1, 1), w});
        }
        detail::SeenPiece<2> seen{&piece, net.data(), {}};
        const double lo = random.real(0, 1), hi = lo + (1 - lo) * std::exp2(random.real(-45, 0));
        const auto at = seen.jet({lo, 0, 0}).value;  // close by: F is far below the size of the piece
        for (std::size_t k = 0; k < 2; ++k) seen.local[k] = at[k] + random.real(-1, 1) * 1e-9;
        const double t = trial % 2 ? 1e-18 : 0;
        std::vector<double> f(std::size_t(2 * piece.degree[0] + 1));
        const auto local = detail::local_form<2>(seen, {lo, 0, 0}, {hi, 0, 0}, piece.degree, t, f.data());
        for (const double x : {0.0, 0.5, 1.0}) {
            std::vector<long double> b(net.begin(), net.end()), g(f.begin(), f.end());
            const long double u = (1 - x) * lo + x * static_cast<long double>(hi);
            for (std::size_t left = g.size() - 1; left > 0; --left)
                for (std::size_t i = 0; i < left; ++i) g[i] = (1 - x) * g[i] + x * g[i + 1];
            for (std::size_t left = b.size() - 3; left > 0; left -= 3)
                for (std::size_t i = 0; i < left; ++i) b[i] = (1 - u) * b[i] + u * b[i + 3];
            long double exact = -static_cast<long double>(t) * b[2] * b[2];
            for (std::size_t k = 0; k < 2; ++k)
                exact += (b[k] - seen.local[k] * b[2]) * (b[k] - seen.local[k] * b[2]);
            EXPECT_LE(std::abs(double(g[0] - exact)), local.offset + 40 * kUnitRoundoff * local.magnitude);
            EXPECT_LE(local.lightest, double(b[2]));
            EXPECT_GE(local.heaviest, double(b[2]));
        }
    }
}

TEST(Nearest, refuses_nonsense) {
    const auto ring = unit_circle();
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(ring)}));
    EXPECT_EQ(NearestQuery::make({}).error().kind, RefusalKind::invalid);
    const std::array<Vec<2>, 2> points{{{{1, 2}}, {{std::nan(""), 0}}}};
    std::array<Nearest<2>, 2> out;
    EXPECT_EQ(query.nearest<2>(points, out).error().where, "points[1]");
    EXPECT_EQ(query.nearest<2>(points[0], {.accuracy = -1}).error().where, "accuracy");
    EXPECT_EQ(query.nearest<2>(points[0], {.accuracy = std::nan("")}).error().where, "accuracy");
    EXPECT_EQ(query.nearest<2>(points[0], {.max_parts = 0}).error().where, "max_parts");
    EXPECT_EQ(NearestQuery::make(std::array{NearestObject::of(ring)}, 100).error().kind, RefusalKind::limit);
    const auto line = must(
        Curve<Vec<3>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<3>>({2}, {{{0, 0, 0}}, {{1, 1, 1}}})));
    EXPECT_EQ(NearestQuery::make(std::array{NearestObject::of(ring), NearestObject::of(line)}).error().where,
              "objects[1]");
}

}  // namespace
}  // namespace freiform::test
