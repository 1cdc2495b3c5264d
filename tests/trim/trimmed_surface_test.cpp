#include "trim/polygons.hpp"

#include <freiform/trim/trimmed_surface.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Loop;
using test::plane_bezier;

// On [0, 2] x [0, 1].
Surface<Vec<3>> plane() {
    return *Surface<Vec<3>>::make(
        {*BSplineBasis::bezier(1, {0, 2}), *BSplineBasis::bezier(1)},
        Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 1, 0}}, {{2, 0, 0}}, {{2, 1, 0}}}));
}

Loop rectangle(double x0, double y0, double x1, double y1) {
    return {plane_bezier({{{x0, y0}}, {{x1, y0}}}), plane_bezier({{{x1, y0}}, {{x1, y1}}}),
            plane_bezier({{{x1, y1}}, {{x0, y1}}}), plane_bezier({{{x0, y1}}, {{x0, y0}}})};
}

Refusal refused(std::vector<Loop> loops) {
    const auto t = TrimmedSurface::make(plane(), std::move(loops));
    EXPECT_FALSE(t);
    return t ? Refusal{} : t.error();
}

TEST(TrimmedSurface, keeps_closed_loops_inside_the_domain) {
    const auto t = TrimmedSurface::make(plane(), {rectangle(0, 0, 2, 1), rectangle(0.5, 0.25, 1, 0.5)});
    ASSERT_TRUE(t) << t.error().message;
    EXPECT_EQ(t->loops.size(), 2u);
    EXPECT_TRUE(TrimmedSurface::make(plane(), {}));
}

TEST(TrimmedSurface, takes_an_ellipse_for_a_whole_loop) {
    const Conic<2> circle{ConicKind::ellipse, {{1, 0.5}}, {{0.5, 0}}, {{0, 0.5}}};
    EXPECT_TRUE(TrimmedSurface::make(plane(), {{circle}}));
    Conic<2> large = circle;
    large.x = {{0.4, 0.4}};
    EXPECT_EQ(refused({{large}}).where, "loops[0][0]");
}

TEST(TrimmedSurface, refuses_a_gap_and_says_its_size) {
    Loop open = rectangle(0, 0, 1, 1);
    open[1] = plane_bezier({{{1, 0}}, {{1, 0.75}}});
    const Refusal r = refused({rectangle(0, 0, 2, 1), open});
    EXPECT_EQ(r.where, "loops[1][1]");
    EXPECT_NE(r.message.find("a gap of 0.25"), std::string::npos) << r.message;
    open = rectangle(0, 0, 1, 1);
    open.pop_back();
    EXPECT_EQ(refused({open}).where, "loops[0][2]");
    Loop rounded = rectangle(0, 0, 1, 1);
    rounded[1] = plane_bezier({{{1, 0}}, {{1, 1 - 1e-12}}});
    EXPECT_TRUE(TrimmedSurface::make(plane(), {rounded}));
}

TEST(TrimmedSurface, refuses_curves_that_leave_the_domain_but_not_control_points_that_do) {
    const Loop cap = {plane_bezier({{{0, 0}}, {{2, 0}}}), plane_bezier({{{2, 0}}, {{1, 1.9}}, {{0, 0}}})};
    EXPECT_TRUE(TrimmedSurface::make(plane(), {cap}));  // the parabola reaches 0.95
    const Loop touching = {plane_bezier({{{0, 0}}, {{2, 0}}}), plane_bezier({{{2, 0}}, {{1, 2}}, {{0, 0}}})};
    EXPECT_TRUE(TrimmedSurface::make(plane(), {touching}));
    const Loop over = {plane_bezier({{{0, 0}}, {{2, 0}}}), plane_bezier({{{2, 0}}, {{1, 2.001}}, {{0, 0}}})};
    const Refusal r = refused({over});
    EXPECT_EQ(r.where, "loops[0][1]");
    EXPECT_EQ(r.kind, RefusalKind::out_of_domain);
}

TEST(TrimmedSurface, refuses_what_has_no_ends_and_empty_loops) {
    EXPECT_NE(refused({{Line<2>{{{0, 0}}, {{1, 0}}}}}).message.find("no ends"), std::string::npos);
    EXPECT_EQ(refused({{}}).where, "loops[0]");
}

TEST(TrimmedSurface, decides_alike_at_every_scale) {
    for (const double s : {0x1p-300, 1.0, 0x1p300}) {
        auto surface = *Surface<Vec<3>>::make(
            {*BSplineBasis::bezier(1, {0, s}), *BSplineBasis::bezier(1, {0, s})}, Net<2, Vec<3>>({2, 2}));
        EXPECT_TRUE(TrimmedSurface::make(surface, {rectangle(0, 0, s, s)}));
        EXPECT_FALSE(TrimmedSurface::make(surface, {rectangle(0, 0, s, s * (1 + 0x1p-20))}));
        Loop open = rectangle(0, 0, s, s);
        open[0] = plane_bezier({{{0, 0}}, {{s * (1 - 0x1p-20), 0}}});
        EXPECT_FALSE(TrimmedSurface::make(surface, {open}));
    }
}

}  // namespace
}  // namespace freiform
