#include "support/bezier.hpp"

#include <freiform/query/continuity.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::random_bezier;

TEST(Knots, that_were_inserted_are_found_removable) {
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        const auto c = random_bezier<Hom<3>>(random, random.integer(2, 6));
        const double at[] = {random.real(0.3, 0.7)};
        const auto all = must(continuity(must(insert_knots(c, 0, at))));
        ASSERT_EQ(all.size(), 1u);
        EXPECT_TRUE(all[0].removable);
        EXPECT_EQ(all[0].joint.g_order, 3);
    }
}

TEST(Knots, of_a_closed_spline_include_the_seam) {
    Random random(5);
    for (const int d : {2, 3, 4}) {
        std::vector<Vec<3>> b;
        for (int i = 0; i < 5; ++i) b.push_back(test::random_coefficient<Vec<3>>(random));
        const auto c = must(Curve<Vec<3>>::make({must(BSplineBasis::periodic(d, {0, 1, 2.5, 3, 4, 6}))},
                                                Net<1, Vec<3>>({5}, b)));
        const auto all = must(continuity(c));
        ASSERT_EQ(all.size(), 5u);
        EXPECT_TRUE(all.back().seam);
        EXPECT_EQ(all.back().at, 0);
        for (const auto& k : all) EXPECT_EQ(k.joint.c_order, d - 1) << k.at;
        // Cut open, it still comes back to its start.
        const auto open = must(continuity(must(restrict_to(c, 0, {0, 6}))));
        ASSERT_EQ(open.size(), 5u);
        EXPECT_TRUE(open.back().seam);
        EXPECT_EQ(open.back().joint.c_order, d - 1);
    }
    EXPECT_TRUE(must(continuity(random_bezier<Vec<2>>(random, 3))).empty());
}

TEST(KnotLines, of_a_surface_have_the_order_of_its_fibres) {
    Random random(10);
    const auto u = must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 1, 2, 3, 3, 3, 3})),
               v = must(BSplineBasis::periodic(2, {0, 1, 2, 4}));
    const auto s = test::random_patch_on<2, Vec<3>>(random, {u, v});
    const auto along_u = must(knot_lines(s, 0)), along_v = must(knot_lines(s, 1));
    ASSERT_EQ(along_u.size(), 2u);
    EXPECT_EQ(along_u[0].c_order, 1);
    EXPECT_EQ(along_u[1].c_order, 2);
    ASSERT_EQ(along_v.size(), 3u);
    EXPECT_TRUE(along_v[2].seam);
    for (const auto& line : along_v) EXPECT_EQ(line.c_order, 1);
    // The jump bounds what is seen at any place of the line.
    const double e = 1e-9;
    for (double y = 0; y < 4; y += 0.1) {
        const auto after = s.jet<2>({1 + e, y}), before = s.jet<2>({1 - e, y});
        EXPECT_LE(norm(after(2, 0) - before(2, 0)), along_u[0].c[2].size + 1e-5);
    }
    const double more[] = {0.5, 2.25};
    const auto fine = must(insert_knots(s, 0, more));
    const auto lines = must(knot_lines(fine, 0));
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0].c_order, 3);
    EXPECT_EQ(lines[3].c_order, 3);
}

// The numbers are taken as exact, so the bounds alone must explain what is left of jumps that are 0 by
// construction: of derivatives up to the order degree - multiplicity, at inner knots and at the seam.
template <class P>
void expect_law_of_knots(std::uint64_t seed) {
    Random random(seed);
    ContinuityOptions exact;
    exact.roundings = 0;
    for (int round = 0; round < 30; ++round) {
        test::BasisOptions shape;
        shape.ends = round % 3 == 0   ? test::Ends::closed
                     : round % 3 == 1 ? test::Ends::clamped
                                      : test::Ends::unclamped;
        shape.jumps = true;
        shape.spans = random.integer(1, 4);
        const int d = random.integer(1, 7);
        const auto c = test::random_patch_on<1, P>(random, {test::random_basis(random, d, shape)});
        for (const auto& k : must(continuity(c, exact)))
            EXPECT_GE(k.joint.c_order, d - k.multiplicity) << "degree " << d << (k.seam ? ", seam" : "");
        for (const auto& l : must(knot_lines(c, 0, exact)))
            EXPECT_GE(l.c_order, d - l.multiplicity) << "degree " << d << (l.seam ? ", seam" : "");
    }
}

TEST(Knots, obey_the_law_of_multiplicity_with_proven_bounds_alone) {
    expect_law_of_knots<Vec<1>>(21);
    expect_law_of_knots<Vec<3>>(22);
    expect_law_of_knots<Vec<4>>(23);
    expect_law_of_knots<Hom<2>>(24);
    expect_law_of_knots<Hom<3>>(25);
}

TEST(Knots, of_a_closed_spline_with_short_spans_leave_the_seam_smooth) {
    // Unwound to the far side, the knots next to the seam are rounded by 1e-13, of spans of 1e-3.
    const std::vector<double> breaks{0.1, 0.1013, 0.1028, 500, 999.999, 1000};
    Random random(26);
    const auto c = test::random_patch_on<1, Vec<3>>(random, {must(BSplineBasis::periodic(3, breaks))});
    const auto all = must(continuity(c));
    EXPECT_TRUE(all.back().seam);
    EXPECT_EQ(all.back().joint.c_order, 2);
    EXPECT_EQ(must(knot_lines(c, 0)).back().c_order, 2);
}

}  // namespace
}  // namespace freiform
