#include "support/random.hpp"

#include <freiform/spline/a_frame.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/subdivision.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using V2 = Vec<2>;

// The Bezier points of a cubic curve, joints once.
template <class P>
std::vector<P> bezier_points(const Curve<P>& curve) {
    const auto pieces = decompose(curve);
    std::vector<P> b;
    for (int i = 0; i < pieces.extent()[0]; ++i)
        for (int k = i == 0 ? 0 : 1; k <= 3; ++k) b.push_back(pieces.net({i})({k}));
    return b;
}

TEST(R13, the_legs_of_an_a_frame_of_a_c2_cubic_meet_in_a_de_boor_point) {
    // Uniform, so that b_{n-1} + (b_{n-1} - b_{n-2}) = c_1 + (c_1 - c_2).
    const auto basis = must(BSplineBasis::make(3, {-3, -2, -1, 0, 1, 2, 3, 4, 5}));
    const std::vector<V2> d{{{0, 0}}, {{6, 12}}, {{18, 6}}, {{24, -6}}, {{36, 0}}};
    const auto curve = must(Curve<V2>::make({basis}, must(Net<1, V2>::make({5}, d))));
    const auto frames = must(a_frames(curve));
    ASSERT_EQ(frames.size(), 1u);
    const auto b = bezier_points(curve);
    EXPECT_EQ(b[2] + (b[2] - b[1]), b[4] + (b[4] - b[5]));
    EXPECT_EQ(frames[0].apex, d[2]);
    EXPECT_EQ(frames[0].gap, 0);
    EXPECT_EQ(frames[0].at, 1);
    EXPECT_EQ(frames[0].joint, 0.5 * (frames[0].from_left[1] + frames[0].from_right[1]));
}

template <class P>
void check_there_and_back(Random& random) {
    for (int spans = 1; spans <= 6; ++spans) {
        const auto breaks = test::random_breaks(random, spans + 1, false);
        std::vector<double> knots(3, breaks.front());
        knots.insert(knots.end(), breaks.begin(), breaks.end());
        knots.insert(knots.end(), 3, breaks.back());
        const auto curve = test::random_patch_on<1, P>(random, {must(BSplineBasis::make(3, knots))});
        const auto b = bezier_points(curve);
        const auto back = must(de_boor_points<P>(b, breaks));
        ASSERT_EQ(back.patch.basis(), curve.basis());
        ASSERT_EQ(int(b.size()), 3 * spans + 1);
        ASSERT_EQ(back.removed, 2 * (spans - 1));
        for (double u : test::parameters(random, curve.basis()))
            ASSERT_LE(norm(back.patch(u) - curve(u)), back.bound);
        EXPECT_LT(back.bound, 1e-11);  // spans differ by up to 2^9
        for (const auto& f : must(a_frames(curve))) EXPECT_LE(f.gap, 1e-11);
        // Each piece depends on four de Boor points: moving one changes at most four pieces.
        auto moved = curve.net();
        moved.flat()[0] += P{{1}};
        const auto other = Curve<P>::trusted(curve.bases(), moved);
        for (double u : test::parameters(random, curve.basis()))
            if (u > breaks[1]) ASSERT_EQ(other(u), curve(u));
    }
}

TEST(R13, de_boor_points_of_a_c2_cubic_bezier_spline_and_back) {
    Random random(81);
    check_there_and_back<Vec<1>>(random);
    check_there_and_back<Vec<3>>(random);
    check_there_and_back<Hom<2>>(random);
}

TEST(DeBoorPoints, of_pieces_that_are_not_c2_have_a_bound_that_says_so) {
    Random random(82);
    const std::vector<double> breaks{0, 1, 3};
    std::vector<V2> b;
    for (int i = 0; i < 7; ++i) b.push_back(test::random_coefficient<V2>(random));
    const auto r = must(de_boor_points<V2>(b, breaks));
    double farthest = 0;
    const auto piece = [&](std::size_t from, double s) {
        V2 p{};
        const double w[] = {(1 - s) * (1 - s) * (1 - s), 3 * s * (1 - s) * (1 - s), 3 * s * s * (1 - s),
                            s * s * s};
        for (std::size_t k = 0; k < 4; ++k) p += w[k] * b[from + k];
        return p;
    };
    for (int k = 0; k <= 64; ++k) {
        const double s = k / 64.0;
        farthest =
            std::max({farthest, norm(r.patch(s) - piece(0, s)), norm(r.patch(1 + 2 * s) - piece(3, s))});
    }
    EXPECT_LE(farthest, r.bound);
    EXPECT_GT(farthest, r.bound / 10);
}

// Pieces that are C^k at a joint, by construction from a spline, are joined with degree - k knots there.
TEST(JoinPieces, finds_the_lowest_multiplicities_that_the_joints_allow) {
    Random random(83);
    for (int p = 1; p <= 7; ++p)
        for (int repeat = 0; repeat < 4; ++repeat) {
            std::vector<double> knots(std::size_t(p) + 1, 0.0), breaks{0};
            for (int i = 1; i <= 4; ++i) {
                breaks.push_back(i);
                knots.insert(knots.end(), std::size_t(i == 4 ? p + 1 : random.integer(1, p)), i);
            }
            const auto basis = must(BSplineBasis::make(p, knots));
            const auto curve = test::random_patch_on<1, Vec<3>>(random, {basis});
            const auto apart = along(0, to_bezier(basis).map, curve.net());
            const auto joined = must(join_pieces<Vec<3>>(apart.flat(), p, breaks, 1e-10));
            ASSERT_EQ(joined.patch.basis(), basis) << p;
            EXPECT_LE(joined.bound, 1e-10);
            for (double u : test::parameters(random, basis))
                ASSERT_LE(norm(joined.patch(u) - curve(u)), joined.bound + 1e-14);
            // Tolerance 0: only what changes nothing, the coefficient that neighbours have in common.
            const auto exact = must(join_pieces<Vec<3>>(apart.flat(), p, breaks, 0));
            EXPECT_EQ(exact.bound, 0);
            int shared = 0;
            for (std::size_t i = 1; i < 4; ++i) {
                const std::size_t at = i * (std::size_t(p) + 1);
                shared += apart.flat()[at - 1] == apart.flat()[at];
            }
            EXPECT_EQ(exact.removed, shared);
            for (std::size_t i = 0; i < 4; ++i)
                for (const double u : {i + 0.0, i + 0.3, i + 0.9})
                    EXPECT_LE(norm(exact.patch(u) - curve(u)), 1e-13);
        }
}

TEST(JoinPieces, keeps_jumps_where_there_are_any) {
    // Two segments that meet, and one elsewhere.
    const std::vector<V2> b{{{0, 0}}, {{1, 0}}, {{1, 0}}, {{2, 1}}, {{5, 5}}, {{6, 5}}};
    const auto joined = must(join_pieces<V2>(b, 1, std::vector<double>{0, 1, 2, 3}, 0));
    EXPECT_EQ(joined.removed, 1);
    EXPECT_EQ(joined.patch.basis().defining().size(), 7u);
    EXPECT_EQ(joined.patch(2), (V2{{5, 5}}));
    EXPECT_EQ(joined.patch(1), (V2{{1, 0}}));
}

TEST(AFrames, refuse_bad_input_by_name_and_index) {
    const auto line = must(Curve<V2>::make({must(BSplineBasis::bezier(1))}, Net<1, V2>({2})));
    EXPECT_EQ(a_frames(line).error().where, "degree");
    const std::vector<V2> b(7);
    EXPECT_EQ(de_boor_points<V2>(b, std::vector<double>{0, 1}).error().where, "points");
    EXPECT_EQ(de_boor_points<V2>(b, std::vector<double>{0, 1, 1}).error().where, "breaks[2]");
    EXPECT_EQ(de_boor_points<V2>(b, std::vector<double>{}).error().where, "breaks");
    EXPECT_EQ(join_pieces<V2>(b, 3, std::vector<double>{0, 1, 2}, 0).error().where, "points");
    EXPECT_EQ(join_pieces<V2>(b, 30, std::vector<double>{0, 1, 2}, 0).error().where, "degree");
    EXPECT_EQ(join_pieces<V2>(b, 6, std::vector<double>{0, 1}, -1).error().where, "tolerance");
}

template <std::size_t N, class P>
void check_subdivision(Random& random) {
    for (int k = 0; k < 12; ++k) {
        const auto s = test::random_patch<N, P>(random, 5, {test::Ends(k % 3), 3, false, true});
        const Interval on = s.basis(0).domain();
        const double u = on.lo + on.length() * random.integer(1, 63) / 64;
        const auto halves = must(split(s, 0, u));
        const auto boehm = must(insert_knot(s, 0, u));
        EXPECT_EQ(halves[0].basis(0).domain(), (Interval{on.lo, u}));
        EXPECT_EQ(halves[1].basis(0).domain(), (Interval{u, on.hi}));
        for (const auto& at : test::parameters(random, s, 20)) {
            const auto& part = component<N>(at, 0) < u ? halves[0] : halves[1];
            ASSERT_LE(norm(part(at) - s(at)), 1e-13);
            ASSERT_LE(norm(boehm(at) - s(at)), 1e-13);
        }
        const auto longer = extend_to(s, 0, {on.lo - 1 / 64., on.hi + 1 / 64.});
        if (Space<P>::kRational && !longer) {
            EXPECT_EQ(longer.error().kind, RefusalKind::invalid);
            continue;
        }
        for (const auto& at : test::parameters(random, s, 20))
            ASSERT_LE(norm(longer->patch(at) - s(at)),
                      longer->bound + 2 * (s.value_error_bound() + longer->patch.value_error_bound()));
        EXPECT_LT(longer->bound, 1e-6);
    }
    EXPECT_EQ(split(test::random_patch<N, P>(random, 3, {}), 0, 1e9).error().kind,
              RefusalKind::out_of_domain);
}

TEST(R16, parts_and_knots_leave_curves_and_surfaces_where_they_are) {
    Random random(84);
    check_subdivision<1, Vec<3>>(random);
    check_subdivision<1, Hom<2>>(random);
    check_subdivision<2, Vec<3>>(random);
}

TEST(R16, a_tube_halved_along_its_closed_uniform_axis_is_the_same_tube) {
    Random random(85);
    const auto around = must(BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5})),
               up = must(BSplineBasis::bezier(2));
    const auto s = test::random_patch_on<2, Vec<3>>(random, {around, up});
    const auto fine = must(halve_uniform(s, 0));
    EXPECT_EQ(fine.basis(0).size(), 10);
    for (const auto& at : test::parameters(random, s, 30)) EXPECT_LE(norm(fine(at) - s(at)), 1e-14);
}

}  // namespace
}  // namespace freiform
