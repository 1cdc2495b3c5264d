#include "../support/solids.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/io/drawing.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

constexpr double kSurfaceTolerance = 3 * kDrawingTolerance;

Document document_of(std::vector<Shape> shapes) {
    Document d;
    for (Shape& s : shapes) d.objects.push_back({text("object", int(d.objects.size())), std::move(s), {}});
    return d;
}

Surface<Vec<3>> bilinear(const std::array<Vec<3>, 4>& c) {
    return *Surface<Vec<3>>::make({*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)},
                                  Net<2, Vec<3>>({2, 2}, {c[0], c[1], c[2], c[3]}));
}
Surface<Vec<3>> square(double z, double a) {
    return bilinear({{{{-a, -a, z}}, {{-a, a, z}}, {{a, -a, z}}, {{a, a, z}}}});
}

// Small, because the mesh is as fine as a tenth of a pixel.
Drawing drawn(const Document& d, DrawingOptions how) {
    how.width = 320, how.height = 240;
    auto r = draw(d, {}, how);
    EXPECT_TRUE(r) << (r ? "" : r.error().message);
    return r ? *r : Drawing{};
}

// Calls f(a, b) for all segments of the groups of a role.
template <class F>
void each_segment(const Drawing& d, std::string_view role, const F& f) {
    for (const DrawnGroup& g : d.groups) {
        if (g.role != role) continue;
        for (const DrawnPath& path : g.paths) {
            Vec<2> from = path.start;
            for (const DrawnSegment& s : path.segments) f(from, end_of(s)), from = end_of(s);
            if (path.closed) f(from, path.start);
        }
    }
}
double length_of(const Drawing& d, std::string_view role) {
    double sum = 0;
    each_segment(d, role, [&](const Vec<2>& a, const Vec<2>& b) { sum += norm(b - a); });
    return sum;
}
Vec<2> plane(const Drawing& d, const Vec<2>& pixel) {
    return {{(pixel[0] - d.origin[0]) / d.scale, (d.origin[1] - pixel[1]) / d.scale}};
}

TEST(HiddenLines, the_outline_of_a_sphere_is_a_circle_of_its_radius) {
    for (const char* view : {"top", "17,-35"})
        for (const double r : {1.0, view[0] == 't' ? 0x1p-200 : 1e100}) {
            DrawingOptions how;
            how.view = *parse_view(view);
            const Drawing d = drawn(document_of({test::sphere({{0, 0, 0}}, r)}), how);
            double worst = 0, thinnest = 1e300;
            each_segment(d, "silhouettes", [&](const Vec<2>& a, const Vec<2>& b) {
                for (const Vec<2>& p : {a, 0.5 * (a + b)}) {
                    const double rho = norm(p - d.origin);
                    worst = std::max(worst, std::abs(rho - r * d.scale));
                }
                thinnest = std::min(thinnest, norm(b - a));
            });
            EXPECT_LE(worst, kSurfaceTolerance) << view;
            EXPECT_NEAR(length_of(d, "silhouettes"), 2 * test::kPi * r * d.scale, 2) << view;
            EXPECT_GT(thinnest, 0.1) << "no zigzag";
            EXPECT_GT(r * d.scale, 100);
        }
}

TEST(HiddenLines, of_a_torus_the_upper_half_is_seen_from_above) {
    DrawingOptions how;
    how.view = *parse_view("top");
    how.isolines = 8;  // none of them lies on an outline
    const Drawing d = drawn(document_of({test::torus(2, 0.7)}), how);
    // Each of the circles in planes through the axis is seen from 1.3 to 2.7 once, and of the 8 around it at
    // equal angles those above the middle.
    double radial = 0, around = 0, outline = 0;
    each_segment(d, "isolines", [&](const Vec<2>& a, const Vec<2>& b) {
        const Vec<2> p = plane(d, a), q = plane(d, b);
        const double along = std::abs(norm(q) - norm(p));
        (along > 0.5 * norm(q - p) ? radial : around) += norm(q - p);
    });
    double expected = 0;
    for (int k = 1; k <= 8; ++k) {
        const double v = 2 * test::kPi * k / 9;
        if (std::sin(v) > 0) expected += 2 * test::kPi * (2 + 0.7 * std::cos(v));
    }
    each_segment(d, "silhouettes",
                 [&](const Vec<2>& a, const Vec<2>& b) { outline += norm(plane(d, b) - plane(d, a)); });
    EXPECT_NEAR(radial, 8 * 1.4, 8 * 4 / d.scale);
    EXPECT_NEAR(around, expected, 0.05);
    EXPECT_NEAR(outline, 2 * test::kPi * 4, 0.05);
}

TEST(HiddenLines, hidden_outlines_are_dashed_too) {
    DrawingOptions how;
    how.view = *parse_view("0,20");
    const Document d = document_of({test::torus(2, 0.7)});  // which has no borders
    EXPECT_EQ(length_of(drawn(d, how), "hidden"), 0);
    how.hidden = HiddenLines::dashed;
    const Drawing dashed = drawn(d, how);
    EXPECT_GT(length_of(dashed, "hidden"), dashed.scale) << "the hole behind the front";
    EXPECT_EQ(length_of(dashed, "edges"), 0);
}

TEST(HiddenLines, an_edge_ends_where_another_face_begins_to_hide_it) {
    DrawingOptions how;
    how.view = *parse_view("top");
    const Document d = document_of({square(0, 2), square(1, 1), square(-1, 1.5)});
    const Drawing plain = drawn(d, how);
    const double unit = plain.scale;
    EXPECT_NEAR(length_of(plain, "edges"), (16 + 8) * unit, 0.01) << "the lowest is hidden wholly";
    EXPECT_EQ(length_of(plain, "hidden"), 0);
    how.hidden = HiddenLines::dashed;
    const Drawing dashed = drawn(d, how);
    EXPECT_NEAR(length_of(dashed, "hidden"), 12 * unit, 0.01);
    for (const DrawnGroup& g : dashed.groups) EXPECT_EQ(g.role == "hidden", !g.dashes.empty());
    how.hidden = HiddenLines::shown;
    EXPECT_NEAR(length_of(drawn(d, how), "edges"), 36 * unit, 0.01);
    // From below the lowest is in front.
    how.hidden = HiddenLines::removed;
    how.view = *parse_view("bottom");
    EXPECT_NEAR(length_of(drawn(d, how), "edges"), (12 + 16) * unit, 0.01);
}

TEST(HiddenLines, a_line_is_cut_at_the_very_place) {
    DrawingOptions how;
    how.view = *parse_view("front");
    const auto upright = [](double x, double y, double z) {
        return bilinear(
            {{{{x - 1, y, z - 1}}, {{x - 1, y, z + 1}}, {{x + 1, y, z - 1}}, {{x + 1, y, z + 1}}}});
    };
    const Drawing d = drawn(document_of({upright(0.75, -5, 0.5), upright(0, 0, 0)}), how);
    std::vector<double> ends;
    each_segment(d, "edges", [&](const Vec<2>& a, const Vec<2>& b) {
        for (const Vec<2>& p : {plane(d, a), plane(d, b)})
            if (std::abs(p[1] - 1) < 1e-6) ends.push_back(p[0]);
    });
    std::ranges::sort(ends);
    ASSERT_FALSE(ends.empty());
    EXPECT_NEAR(ends.front(), -1, 1e-9);
    EXPECT_NEAR(ends.back(), -0.25, 1e-9);
}

TEST(HiddenLines, control_nets_are_dimmed_behind) {
    DrawingOptions how;
    how.control = true;
    how.view = *parse_view("top");
    const Drawing d = drawn(document_of({square(1, 1), square(0, 0.5)}), how);
    EXPECT_NEAR(length_of(d, "control"), 8 * d.scale, 0.01);
    EXPECT_NEAR(length_of(d, "control-behind"), 4 * d.scale, 0.01);
}

Curve<Vec<3>> bezier3(std::vector<Vec<3>> c) {
    const int n = int(c.size());
    return *Curve<Vec<3>>::make({*BSplineBasis::bezier(n - 1)}, Net<1, Vec<3>>({n}, std::move(c)));
}

TEST(HiddenLines, surfaces_hide_curves_and_their_polygons) {
    DrawingOptions how;
    how.view = *parse_view("top");
    // From x = -2 to 2 below a square from -1 to 1.
    const Document below = document_of(
        {square(1, 1), bezier3({{{-2, 0.3, 0}}, {{-0.5, 0.3, 0}}, {{0.6, 0.3, 0}}, {{2, 0.3, 0}}})});
    const Drawing seen = drawn(below, how);
    EXPECT_NEAR(length_of(seen, "curve"), 2 * seen.scale, 0.01);
    EXPECT_EQ(length_of(seen, "hidden"), 0);
    each_segment(seen, "curve", [&](const Vec<2>& a, const Vec<2>& b) {
        EXPECT_GE(std::abs(plane(seen, 0.5 * (a + b))[0]), 1) << "outside of the square";
    });
    how.control = true;
    how.hidden = HiddenLines::dashed;
    const Drawing dashed = drawn(below, how);
    EXPECT_NEAR(length_of(dashed, "hidden"), 2 * dashed.scale, 0.01);
    EXPECT_NEAR(length_of(dashed, "control"), (8 + 2) * dashed.scale, 0.01)
        << "the square's net and the ends";
    EXPECT_NEAR(length_of(dashed, "control-behind"), 2 * dashed.scale, 0.01);
    std::size_t points = 0, dimmed = 0;
    for (const DrawnGroup& g : dashed.groups)
        (g.role == "control" ? points : dimmed) += g.role.starts_with("control") ? g.discs.size() : 0;
    EXPECT_EQ(points, 4u + 2u);
    EXPECT_EQ(dimmed, 2u);
    how.hidden = HiddenLines::shown;
    const Drawing glass = drawn(below, how);
    EXPECT_NEAR(length_of(glass, "curve"), 4 * glass.scale, 0.01);
}

TEST(HiddenLines, curves_that_nothing_hides_stay_curves) {
    DrawingOptions how;
    how.view = *parse_view("top");
    how.knots = true;
    const auto cubic = bezier3({{{-2, 0.3, 2}}, {{-1, 1.5, 2}}, {{1, -1.5, 2}}, {{2, 0.3, 2}}});
    const Drawing above = drawn(document_of({square(1, 1), cubic}), how);
    std::size_t paths = 0, knots = 0;
    for (const DrawnGroup& g : above.groups) {
        knots += g.role == "knots" ? g.discs.size() : 0;
        if (g.role != "curve") continue;
        paths += g.paths.size();
        for (const DrawnPath& path : g.paths)
            for (const DrawnSegment& s : path.segments) EXPECT_EQ(s.degree, 3);
    }
    EXPECT_EQ(paths, 1u);
    EXPECT_EQ(knots, 2u);
    how.view = *parse_view("bottom");
    EXPECT_EQ(length_of(drawn(document_of({square(1, 3), cubic}), how), "curve"), 0);
    std::size_t left = 0;
    for (const DrawnGroup& g : drawn(document_of({square(1, 3), cubic}), how).groups)
        if (g.role == "knots") left += g.discs.size();
    EXPECT_EQ(left, 0u) << "knots of a hidden curve";
}

TEST(HiddenLines, a_curve_on_a_surface_is_seen_where_the_surface_faces_the_eye) {
    // A parallel circle of a sphere, seen from -y, from 0, 20 and 50 degrees above.
    const double z = 0.6, r = 0.8, w = std::sqrt(0.5);
    std::vector<Hom<3>> c;
    for (int i = 0; i < 9; ++i) {
        const double a = test::kPi / 4 * i, far = i % 2 ? r / w : r;
        c.push_back(weighted(Vec<3>{{far * std::cos(a), far * std::sin(a), z}}, i % 2 ? w : 1));
    }
    const auto circle = *Curve<Hom<3>>::make({*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4})},
                                             Net<1, Hom<3>>({9}, c));
    DrawingOptions how;
    for (const auto& [view, elevation] : {std::pair("front", 0.0), {"-90,20", 20.0}, {"-90,50", 50.0}}) {
        how.view = *parse_view(view);
        how.hidden = HiddenLines::dashed;
        const Drawing d = drawn(document_of({test::sphere({{0, 0, 0}}, 1), circle}), how);
        // The point at the angle a is seen where (r cos a, r sin a, z) . eye > 0, eye = (0, -ce, se). Near
        // the outline, where the curve leaves it, both is right.
        const double e = elevation * test::kPi / 180, limit = z * std::sin(e) / (r * std::cos(e));
        const auto inside = [&](const Vec<2>& p) { return norm(p) < 1 - 1.5 / d.scale; };
        const auto length = [&](std::string_view role) {
            double sum = 0;
            each_segment(d, role, [&](const Vec<2>& a, const Vec<2>& b) {
                for (int i = 0; i < 20; ++i)
                    if (inside(plane(d, a + (i + 0.5) / 20 * (b - a)))) sum += norm(b - a) / 20;
            });
            return sum / d.scale;
        };
        double front = 0, back = 0;
        constexpr int kSteps = 100000;
        for (int i = 0; i < kSteps; ++i) {
            const double a = 2 * test::kPi * (i + 0.5) / kSteps, ca = std::cos(a), sa = std::sin(a);
            if (inside({{r * ca, r * sa * std::sin(e) + z * std::cos(e)}}))
                (sa < limit ? front : back) += 2 * test::kPi / kSteps * r * std::hypot(sa, ca * std::sin(e));
        }
        EXPECT_NEAR(length("curve"), front, 1 / d.scale) << view;
        EXPECT_NEAR(length("hidden"), back, 1 / d.scale) << view;
        EXPECT_GT(front + back, 3) << "most of the curve is inside of the outline";
    }
}

TEST(HiddenLines, edges_of_a_volume_are_hidden_by_a_surface_beside_it) {
    std::vector<Vec<3>> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({{i & 4 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 1 ? -1.0 : -2.0}});
    const auto line = *BSplineBasis::bezier(1);
    const auto block = *Volume<Vec<3>>::make({line, line, line}, Net<3, Vec<3>>({2, 2, 2}, corners));
    DrawingOptions how;
    how.view = *parse_view("top");
    const Drawing d = drawn(document_of({square(0, 1), block}), how);
    EXPECT_NEAR(length_of(d, "edges"), 8 * d.scale, 0.01) << "those of the square";
}

TEST(HiddenLines, do_not_depend_on_threads_and_have_ids_per_face) {
    const Document d = document_of({test::torus(2, 0.7), test::sphere({{0, 0, 3}}, 1)});
    DrawingOptions how;
    how.isolines = 3;
    const std::string one = to_svg(drawn(d, how));
    const int before = max_threads();
    set_max_threads(1);
    const std::string again = to_svg(drawn(d, how));
    set_max_threads(before);
    EXPECT_EQ(one, again);
    EXPECT_NE(one.find("<g id=\"object0-face-0-isolines\">"), std::string::npos);
    EXPECT_NE(one.find("id=\"object1-silhouettes\""), std::string::npos);
    std::size_t open = 0, close = 0;
    for (std::size_t i = 0; (i = one.find("<g ", i)) != std::string::npos; ++i) ++open;
    for (std::size_t i = 0; (i = one.find("</g>", i)) != std::string::npos; ++i) ++close;
    EXPECT_EQ(open, close);
}

TEST(HiddenLines, objects_take_the_colours_of_the_palette_in_turn) {
    std::vector<Shape> squares;
    for (int i = 0; i < 5; ++i) squares.push_back(square(i, 6 - i));
    DrawingOptions how;
    how.view = *parse_view("top");
    how.control = true;
    const auto colours = [&] {
        std::vector<Colour> out;
        for (const DrawnGroup& g : drawn(document_of(squares), how).groups)
            if (g.role == "control" && std::ranges::find(out, g.colour) == out.end()) out.push_back(g.colour);
        return out;
    };
    EXPECT_EQ(colours().size(), 1u) << "many are drawn alike";
    how.palette = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
    const auto c = colours();
    ASSERT_EQ(c.size(), 3u);
    EXPECT_TRUE(c[0].r > c[0].g && c[1].g > c[1].r && c[2].b > c[2].r);
}

TEST(HiddenLines, refuse_counts_that_make_no_sense) {
    DrawingOptions how;
    how.isolines = -1;
    EXPECT_EQ(draw(document_of({test::torus(2, 0.7)}), {}, how).error().where, "isolines");
    how.isolines = 1001;
    EXPECT_EQ(draw(document_of({test::torus(2, 0.7)}), {}, how).error().where, "isolines");
}

TEST(HiddenLines, of_a_graph_in_space_hide_each_other) {
    // z = 8 u (1 - u), seen from the side: the hill hides nothing of itself but its back.
    const auto graph =
        *Surface<Vec<1>>::make({*BSplineBasis::bezier(2), *BSplineBasis::bezier(1)},
                               Net<2, Vec<1>>({3, 2}, {{{0}}, {{0}}, {{4}}, {{4}}, {{0}}, {{0}}}));
    DrawingOptions how;
    how.view = *parse_view("0,20");  // from x, a little above
    const Drawing d = drawn(document_of({graph}), how);
    EXPECT_NEAR(length_of(d, "silhouettes"), d.scale, 0.3) << "the ridge, as seen from there";
    how.hidden = HiddenLines::dashed;
    EXPECT_GT(length_of(drawn(document_of({graph}), how), "hidden"), 0.5 * d.scale);
}

}  // namespace
}  // namespace freiform
