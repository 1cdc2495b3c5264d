#include "random.hpp"
#include "shapes.hpp"

#include <freiform/intersect/curve_surface.hpp>

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

using Flat = Surface<Vec<3>>;

// z = f over [0, 3] x [0, 3]: control points (i, j, heights).
Flat graph_surface(const std::vector<double>& heights) {
    Net<2, Vec<3>> net({4, 4});
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            net.view()({i, j}) = {{double(i), double(j), heights[std::size_t(4 * i + j)]}};
    const BSplineBasis cubic = must(BSplineBasis::bezier(3));
    return must(Flat::make({cubic, cubic}, std::move(net)));
}
Flat bumpy(Random& random) {
    std::vector<double> z;
    for (int i = 0; i < 16; ++i) z.push_back(random.real(-1, 1));
    return graph_surface(z);
}

TEST(IntersectSurfaces, every_upright_line_meets_a_graph_once) {
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        const Flat s = bumpy(random);
        const IntersectSurface<Vec<3>> ready(s);
        std::vector<StraightLine> lines;
        for (int k = 0; k < 20; ++k)
            lines.push_back(
                {{{random.real(0.01, 2.99), random.real(0.01, 2.99), random.real(-3, 3)}}, {{0, 0, 2}}});
        std::vector<Intersections<3, 3>> out(lines.size());
        ASSERT_TRUE(ready.intersect(lines, out).has_value());
        for (std::size_t k = 0; k < lines.size(); ++k) {
            ASSERT_EQ(out[k].contacts.size(), 1u);
            const auto& c = out[k].contacts[0];
            EXPECT_TRUE(c.is_proven());
            EXPECT_EQ(c.kind, ContactKind::crossing);
            EXPECT_NEAR(c.at[1], lines[k].point[0] / 3, 1e-14);
            EXPECT_NEAR(c.at[2], lines[k].point[1] / 3, 1e-14);
            EXPECT_NEAR(lines[k].point[2] + 2 * c.at[0], s(c.at[1], c.at[2])[2], 1e-13);
            EXPECT_LT(c.gap, 1e-13);
        }
    }
}

TEST(IntersectSurfaces, a_line_along_a_wave_meets_it_as_often_as_the_wave_turns) {
    // The same wave for all v: a Chebyshev polynomial, which takes every value of (-1, 1) three times.
    std::vector<double> z;
    for (const double h : {-1.0, 5.0, -5.0, 1.0}) z.insert(z.end(), 4, h);
    const IntersectSurface<Vec<3>> wave(graph_surface(z));
    const auto through = must(wave.intersect({{{0, 0.3, 0.2}}, {{1, 0.5, 0}}}));
    EXPECT_EQ(through.contacts.size(), 3u);
    for (const auto& c : through.contacts) EXPECT_TRUE(c.is_proven());
    EXPECT_TRUE(must(wave.intersect({{{0, 0.3, 1.0001}}, {{1, 0.5, 0}}})).contacts.empty());
    // On the crest: nothing can be told, and that is said.
    const auto crest = must(wave.intersect({{{0, 0.3, 1}}, {{1, 0.5, 0}}}));
    ASSERT_GE(crest.contacts.size(), 1u);
    for (const auto& c : crest.contacts) EXPECT_EQ(c.least, 0);
    EXPECT_TRUE(crest.undecided.empty());
    // Rays and segments keep to their interval.
    EXPECT_EQ(must(wave.intersect({{{1.5, 1.5, 0}}, {{1, 0.5, 0.01}}, {0.01, 1e300}})).contacts.size(), 1u);
}

TEST(IntersectSurfaces, knot_lines_and_patch_corners_count_once) {
    Random random(3);
    for (int i = 0; i < 6; ++i) {
        Flat s = bumpy(random);
        const double at[] = {0.25, 0.5}, twice[] = {0.5, 0.5, 0.5};
        s = must(insert_knots(s, 0, std::span(at)));
        s = must(insert_knots(s, 1, std::span(twice)));
        const IntersectSurface<Vec<3>> ready(s);
        for (const Vec<2>& p :
             {Vec<2>{{0.75, 1.5}}, Vec<2>{{1.5, 1.5}}, Vec<2>{{1.5, 0.7}}, Vec<2>{{2, 1.5}}}) {
            const auto found = must(ready.intersect({{{p[0], p[1], -4}}, {{0, 0, 1}}}));
            ASSERT_EQ(found.contacts.size(), 1u);
            EXPECT_EQ(found.contacts[0].most, 1);
            EXPECT_TRUE(found.contacts[0].is_proven());
        }
    }
}

TEST(IntersectSurfaces, a_line_through_the_boundary_of_a_flat_patch_meets_its_end) {
    const IntersectSurface<Vec<3>> flat(graph_surface(std::vector<double>(16, 0.0)));
    for (const Vec<2>& p : {Vec<2>{{0, 1}}, Vec<2>{{0, 0}}, Vec<2>{{3, 1.25}}}) {
        const auto found = must(flat.intersect({{{p[0], p[1], -1}}, {{0, 0, 1}}}));
        ASSERT_EQ(found.contacts.size(), 1u);
        EXPECT_EQ(found.contacts[0].kind, ContactKind::end);
        EXPECT_EQ(found.contacts[0].least, 0);
        EXPECT_LT(found.contacts[0].box[1].length(), 1e-12);
    }
}

TEST(IntersectSurfaces, curves_and_rational_surfaces) {
    // A cone of a circle's quarter: (1 - v) (arc, 0) + v (0, 0, 1).
    using P = Hom<3>;
    Net<2, P> net(
        {3, 2},
        {{{1, 0, 0, 1}}, {{0, 0, 1, 1}}, {{1, 1, 0, 1}}, {{0, 0, 1, 1}}, {{0, 2, 0, 2}}, {{0, 0, 2, 2}}});
    const auto cone =
        must(Surface<P>::make({must(BSplineBasis::bezier(2)), must(BSplineBasis::bezier(1))}, net));
    const auto curve = must(
        Curve<P>::make({must(BSplineBasis::bezier(2))},
                       Net<1, P>({3}, {{{0.1, 0.1, 0.1, 1}}, {{0.5, 0.4, 0.2, 1}}, {{0.6, 1.2, 0.3, 1}}})));
    const auto found = must(intersect(curve, cone));
    ASSERT_EQ(found.contacts.size(), 1u);
    const auto& c = found.contacts[0];
    EXPECT_TRUE(c.is_proven());
    const Vec<3> x = curve(c.at[0]);
    EXPECT_NEAR(std::hypot(x[0], x[1]), 1 - x[2], 1e-14);
    EXPECT_LT(norm(x - cone(c.at[1], c.at[2])), 1e-14);
}

TEST(IntersectSurfaces, a_curve_in_the_surface_is_not_called_a_crossing) {
    Random random(5);
    const Flat s = bumpy(random);
    const auto found = must(intersect(iso(s, 0, 0.5), s, {.accuracy = 0, .max_parts = 3000}));
    EXPECT_FALSE(found.contacts.empty() && found.undecided.empty());
    for (const auto& c : found.contacts) EXPECT_FALSE(c.is_proven());
}

TEST(IntersectSurfaces, bad_lines_are_refused) {
    Random random(6);
    const IntersectSurface<Vec<3>> ready(bumpy(random));
    EXPECT_EQ(ready.intersect({{{0, NAN, 0}}, {{0, 0, 1}}}).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(ready.intersect({{{0, 0, 0}}, {{0, 0, 0}}}).error().where, "lines[0]");
    EXPECT_FALSE(ready.intersect({{{0, 0, 0}}, {{0, 0, 1}}, {1, 0}}).has_value());
    EXPECT_FALSE(ready.intersect({{{1, 1, 0}}, {{0, 0, 1}}, {0, 0}}).has_value()) << "a point is no line";
    // Parameters beyond doubles are not taken for no contact.
    EXPECT_EQ(must(ready.intersect({{{1, 1, -4}}, {{0, 0, 0x1p-1070}}})).undecided.size(), 1u);
    EXPECT_FALSE(ready.intersect({{{0, 0, 0}}, {{0, 0, 1}}}, {.accuracy = -1}).has_value());
}

}  // namespace
}  // namespace freiform::test
