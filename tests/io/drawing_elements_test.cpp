#include "shapes.hpp"

#include <freiform/io/drawing.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <random>

using namespace freiform;

namespace {

template <class P>
Document document_with(const Curve<P>& curve) {
    Document d;
    d.objects.push_back({"c", curve, {}});
    return d;
}

template <class P>
Curve<P> bezier_curve(std::vector<P> c) {
    const int n = int(c.size());
    return *Curve<P>::make({*BSplineBasis::bezier(n - 1)}, Net<1, P>({n}, std::move(c)));
}

// A quarter of the circle of this radius around the origin.
Curve<Hom<2>> arc(double r) {
    return bezier_curve<Hom<2>>(
        {weighted<2>({{r, 0}}, 1), weighted<2>({{r, r}}, std::sqrt(0.5)), weighted<2>({{0, r}}, 1)});
}

const DrawnGroup& group_of(const Drawing& d, std::string_view role, std::string_view layer = "") {
    for (const DrawnGroup& g : d.groups)
        if (g.role == role && g.layer == layer) return g;
    static const DrawnGroup kNone{};
    ADD_FAILURE() << "there is no " << role;
    return kNone;
}

Vec<2> picture_of(const Drawing& d, const Vec<2>& p) {
    return {{d.origin[0] + d.scale * p[0], d.origin[1] - d.scale * p[1]}};
}

}  // namespace

TEST(Elements, the_circle_of_curvature_of_an_arc_is_its_circle) {
    DrawingOptions how;
    for (const double at : {0.0, 0.3, 1.0}) {
        how.osculating = at;
        const auto d = draw(document_with(arc(2)), {}, how);
        ASSERT_TRUE(d) << d.error().message;
        const auto& path = group_of(*d, "osculating").paths.at(0);
        EXPECT_GT(path.segments.size(), 15u);
        for (const DrawnSegment& s : path.segments)
            EXPECT_NEAR(norm(end_of(s) - picture_of(*d, {})) / d->scale, 2, 1e-9);
    }
}

TEST(Elements, a_large_circle_of_curvature_is_an_arc_that_fits) {
    DrawingOptions how;
    how.osculating = 0.5;
    const auto d = draw(document_with(bezier_curve<Vec<2>>({{{0, 0}}, {{1, 0.01}}, {{2, 0}}})), {}, how);
    ASSERT_TRUE(d);
    EXPECT_GT(d->scale, 300) << "the curve would be a point beside a whole circle of radius 100";
    how.osculating = 0.5;
    const auto line = draw(document_with(bezier_curve<Vec<2>>({{{0, 0}}, {{1, 1}}})), {}, how);
    ASSERT_TRUE(line);
    EXPECT_EQ(line->left_out.size(), 1u) << "a line has none, which is said";
}

TEST(Elements, tangent_and_normal_are_orthogonal_and_on_the_side_of_the_centre) {
    DrawingOptions how;
    how.tangent = 0.25;
    const auto d = draw(document_with(arc(1)), {}, how);
    ASSERT_TRUE(d);
    const Vec<2> p = picture_of(*d, arc(1)(0.25)),
                 t = group_of(*d, "tangent").paths[0].segments[0].points[0] - p,
                 n = group_of(*d, "normal").paths[0].segments[0].points[0] - p,
                 to_centre = picture_of(*d, {}) - p;
    EXPECT_NEAR(dot(unit(t), unit(n)), 0, 1e-9);
    EXPECT_NEAR(dot(unit(n), unit(to_centre)), 1, 1e-9);
    EXPECT_LT(cross(t, to_centre), 0) << "counter-clockwise, seen document_with y down";
}

TEST(Elements, the_hull_holds_all_control_points) {
    std::mt19937 rng(5);
    DrawingOptions how;
    how.hull = how.control = true;
    for (int i = 0; i < 20; ++i) {
        const auto d = draw(document_with(test::random_patch<1, Vec<2>>(rng, {3}, 4)), {}, how);
        ASSERT_TRUE(d);
        const DrawnPath& path = group_of(*d, "hull").paths.at(0);
        std::vector<Vec<2>> corners{path.start};
        for (const DrawnSegment& s : path.segments) corners.push_back(end_of(s));
        for (const DrawnDisc& disc : group_of(*d, "control").discs)
            for (std::size_t k = 0; k < corners.size(); ++k) {
                const Vec<2>& a = corners[k];
                const Vec<2>& b = corners[(k + 1) % corners.size()];
                EXPECT_LE(cross(b - a, disc.centre - a), 1e-6) << "on the left, y down";
            }
    }
}

TEST(Elements, the_box_touches_the_curve_on_all_sides) {
    DrawingOptions how;
    how.box = true;
    const auto d = draw(document_with(arc(1)), {}, how);
    ASSERT_TRUE(d);
    const DrawnGroup& g = group_of(*d, "box");
    const Box<2> box = box_of(std::span(&g, 1));
    EXPECT_LT(norm(box.lo - picture_of(*d, {{0, 1}})), 0.2);
    EXPECT_LT(norm(box.hi - picture_of(*d, {{1, 0}})), 0.2);
}

TEST(Elements, every_control_point_and_every_point_of_the_scheme_has_its_name) {
    DrawingOptions how;
    how.names = PointNames::from_zero;
    how.construction = 0.4;
    const auto d =
        draw(document_with(bezier_curve<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}})), {}, how);
    ASSERT_TRUE(d);
    std::vector<std::string> names;
    for (const DrawnGroup& g : d->groups)
        for (const DrawnLabel& l : g.labels) {
            std::string s;
            for (const DrawnRun& run : l.text) s += run.text;
            names.push_back(s);
        }
    std::ranges::sort(names);
    EXPECT_EQ(names,
              (std::vector<std::string>{"b0", "b01", "b02", "b03", "b1", "b11", "b12", "b2", "b21", "b3"}));
}

TEST(Elements, the_hodograph_of_a_parabola_is_a_line_seen_from_the_origin) {
    DrawingOptions how;
    how.hodograph = true;
    const auto d = draw(document_with(bezier_curve<Vec<2>>({{{0, 0}}, {{1, 2}}, {{2, 0}}})), {}, how);
    ASSERT_TRUE(d);
    const DrawnPath& path = group_of(*d, "hodograph", "hodograph").paths.at(0);
    ASSERT_EQ(path.segments.size(), 1u);
    EXPECT_EQ(path.segments[0].degree, 1);
    // From 2 (1, 2) to 2 (1, -2): upright, and the origin is 2 to the left of its middle.
    const Vec<2> origin = group_of(*d, "origin", "hodograph").discs.at(0).centre, end = end_of(path);
    EXPECT_NEAR(path.start[0], end[0], 1e-9);
    EXPECT_NEAR((end[1] - path.start[1]) / (end[0] - origin[0]), 4, 1e-9);
}

TEST(Elements, hodographs_of_rational_curves_follow_their_derivatives) {
    DrawingOptions how;
    how.hodograph = true;
    const auto d = draw(document_with(arc(1)), {}, how);
    ASSERT_TRUE(d);
    const DrawnPath& path = group_of(*d, "hodograph", "hodograph").paths.at(0);
    const Vec<2> origin = group_of(*d, "origin", "hodograph").discs.at(0).centre;
    ASSERT_EQ(path.segments.size(), 400u);
    const double scale = norm(path.start - origin) / norm(arc(1).jet<1>(0.0)(1));
    for (int i = 1; i <= 400; ++i) {
        const Vec<2> v = arc(1).jet<1>(i / 400.0)(1);
        EXPECT_LT(norm(origin + scale * Vec<2>{{v[0], -v[1]}} - end_of(path.segments[std::size_t(i) - 1])),
                  1e-6);
    }
}

TEST(Elements, basis_functions_sum_to_one) {
    DrawingOptions how;
    how.basis = true;
    std::mt19937 rng(3);
    const auto c = test::random_patch<1, Vec<2>>(rng, {2}, 3);
    std::vector<Refusal> left_out;
    const auto panels = panels_of(document_with(c), {}, how, left_out);
    ASSERT_TRUE(panels);
    ASSERT_EQ(panels->size(), 2u);
    const double u = c.domain()[0].middle();
    double sum = 0;
    int functions = 0;
    for (const DrawnGroup& g : (*panels)[1].groups) {
        if (g.role != "basis") continue;
        ++functions;
        for (const DrawnPath& path : g.paths) {
            Vec<2> from = path.start;
            for (const DrawnSegment& s : path.segments) {
                const Vec<2> end = end_of(s);
                // x runs evenly along each piece of a graph.
                if (from[0] <= u && u < end[0])
                    sum += point_at(from, s, (u - from[0]) / (end[0] - from[0]))[1];
                from = end;
            }
        }
    }
    EXPECT_EQ(functions, c.basis().size());
    EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(Elements, joints_say_their_orders) {
    // Knots of multiplicity 1, 2, 3 in a cubic, and a next curve document_with the tangent of its end, twice
    // as long.
    const std::vector<Vec<2>> c{{{0, 0}}, {{1, 3}}, {{2, 0}}, {{3, 3}}, {{4, 0}},
                                {{5, 2}}, {{6, 0}}, {{7, 3}}, {{8, 0}}, {{9, 1}}};
    Document d = document_with(*Curve<Vec<2>>::make(
        {*BSplineBasis::make(3, {0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 4, 4, 4, 4})}, Net<1, Vec<2>>({10}, c)));
    d.objects.push_back({"next", bezier_curve<Vec<2>>({{{9, 1}}, {{11, 3}}, {{12, 0}}}), {}});
    DrawingOptions how;
    how.joints = true;
    const auto drawing = draw(d, {}, how);
    ASSERT_TRUE(drawing) << drawing.error().message;
    EXPECT_TRUE(drawing->left_out.empty());
    std::vector<std::string> names;
    std::vector<Vec<2>> places;
    for (const DrawnGroup& g : drawing->groups) {
        for (const DrawnLabel& l : g.labels) {
            std::string s;
            for (const DrawnRun& run : l.text) s += run.text;
            names.push_back(s);
        }
        if (g.role == "joints")
            for (const DrawnDisc& disc : g.discs) places.push_back(disc.centre);
    }
    std::ranges::sort(names);
    EXPECT_EQ(names, (std::vector<std::string>{"C0 G0", "C0 G1", "C1 G1", "C2 G2"}));
    ASSERT_EQ(places.size(), 4u);
    EXPECT_LT(norm(places[3] - picture_of(*drawing, {{9, 1}})), 1e-9) << "where the curves meet";
    how.joints = false;
    const auto without = draw(d, {}, how);
    ASSERT_TRUE(without);
    for (const DrawnGroup& g : without->groups) EXPECT_NE(g.role, "joints");
}

TEST(Elements, the_apex_of_an_a_frame_is_a_control_point) {
    std::mt19937 rng(8);
    const auto c = test::random_patch<1, Vec<2>>(rng, {3}, 2);
    DrawingOptions how;
    how.a_frames = true;
    const auto d = draw(document_with(c), {}, how);
    ASSERT_TRUE(d);
    const auto& paths = group_of(*d, "a-frames").paths;
    ASSERT_EQ(paths.size(), 6u) << "a triangle and two legs at each of two knots";
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec<2> apex = paths[3 * k].segments[0].points[0], b = picture_of(*d, c.net().flat()[k + 2]);
        EXPECT_LT(norm(apex - b), 1e-6);
        EXPECT_TRUE(paths[3 * k].closed);
    }
}

TEST(Elements, scale_with_the_curve_to_the_last_byte) {
    std::mt19937 rng(9);
    const auto c = test::random_patch<1, Hom<2>>(rng, {4}, 3);
    DrawingOptions how;
    how.box = how.hull = how.joints = true;
    how.names = PointNames::from_one;
    how.tangent = how.osculating = how.construction = c.domain()[0].middle();
    for (const double by : {0x1p40, 0x1p-600, 0x1p600}) {
        std::vector<Hom<2>> scaled(c.net().flat().begin(), c.net().flat().end());
        for (auto& p : scaled) p[0] *= by, p[1] *= by;
        const auto other = Curve<Hom<2>>::make(c.bases(), Net<1, Hom<2>>(c.net().extent(), scaled));
        const auto a = draw(document_with(c), {}, how), b = draw(document_with(*other), {}, how);
        ASSERT_TRUE(a && b);
        EXPECT_EQ(to_svg(*a), to_svg(*b)) << by;
    }
}

TEST(Elements, parameters_outside_are_refused_by_name) {
    const auto c = bezier_curve<Vec<2>>({{{0, 0}}, {{1, 2}}, {{2, 0}}});
    DrawingOptions how;
    how.tangent = 2;
    auto d = draw(document_with(c), {}, how);
    ASSERT_FALSE(d);
    EXPECT_EQ(d.error().kind, RefusalKind::out_of_domain);
    EXPECT_NE(d.error().message.find("tangent"), std::string::npos);
    how = {};
    how.osculating = -1;
    d = draw(document_with(c), {}, how);
    ASSERT_FALSE(d);
    EXPECT_EQ(d.error().kind, RefusalKind::out_of_domain);
    how.osculating = std::nan("");
    EXPECT_EQ(draw(document_with(c), {}, how).error().kind, RefusalKind::nonfinite);
}
