#include "shapes.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/drawing.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

using namespace freiform;

namespace {

template <class P>
Curve<P> bezier(std::vector<P> c) {
    const int n = int(c.size());
    return *Curve<P>::make({*BSplineBasis::bezier(n - 1)}, Net<1, P>({n}, std::move(c)));
}

Document with(Shape shape, std::string name = "") {
    Document d;
    d.objects.push_back({std::move(name), std::move(shape), {}});
    return d;
}

Curve<Hom<2>> circle(double radius, Vec<2> centre) {
    const double w = std::sqrt(0.5);
    const std::array<std::array<double, 2>, 9> at{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}}};
    std::vector<Hom<2>> c;
    for (std::size_t i = 0; i < 9; ++i)
        c.push_back(weighted(centre + radius * Vec<2>{{at[i][0], at[i][1]}}, i % 2 ? w : 1));
    return *Curve<Hom<2>>::make({*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4})},
                                Net<1, Hom<2>>({9}, c));
}

const DrawnGroup* group(const Drawing& d, std::string_view role) {
    for (const DrawnGroup& g : d.groups)
        if (g.role == role) return &g;
    return nullptr;
}

Vec<2> pixel(const Drawing& d, const Vec<2>& p) {
    return {{d.origin[0] + d.scale * p[0], d.origin[1] - d.scale * p[1]}};
}

double distance(const Vec<2>& p, const Vec<2>& a, const Vec<2>& b) {
    const Vec<2> d = b - a;
    const double t = dot(d, d) > 0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0) : 0;
    return norm(p - a - t * d);
}

// From p to the polylines.
double distance(const Vec<2>& p, const DrawnGroup& g) {
    double least = std::numeric_limits<double>::infinity();
    for (const DrawnPath& path : g.paths) {
        Vec<2> from = path.start;
        for (const DrawnSegment& s : path.segments) {
            EXPECT_EQ(s.degree, 1);
            least = std::min(least, distance(p, from, s.points[0]));
            from = s.points[0];
        }
    }
    return least;
}

void expect_inside(const Drawing& d) {
    const auto inside = [&](const Vec<2>& p) {
        EXPECT_TRUE(is_finite(p));
        EXPECT_TRUE(p[0] >= 0 && p[0] <= d.width && p[1] >= 0 && p[1] <= d.height) << p[0] << ' ' << p[1];
    };
    for (const DrawnGroup& g : d.groups) {
        for (const DrawnPath& path : g.paths) {
            inside(path.start);
            for (const DrawnSegment& s : path.segments) inside(s.points[std::size_t(s.degree - 1)]);
        }
        for (const DrawnDisc& disc : g.discs) inside(disc.centre);
    }
}

std::vector<double> numbers_of(std::string_view path) {
    std::vector<double> out;
    std::string word;
    for (const char c : std::string(path) + " ") {
        if (c == ' ' || (c >= 'A' && c <= 'Z')) {
            if (const auto x = scan_number<double>(word)) out.push_back(*x);
            word.clear();
        } else {
            word += c;
        }
    }
    return out;
}

// The data of the paths with this class.
std::vector<std::string> paths_in(const std::string& svg, const std::string& role) {
    std::vector<std::string> out;
    const std::size_t begin = svg.find("<g class=\"" + role + "\""), end = svg.find("</g>", begin);
    for (std::size_t at = svg.find("<path d=\"", begin); at < end; at = svg.find("<path d=\"", at + 1))
        out.push_back(svg.substr(at + 9, svg.find('"', at + 9) - at - 9));
    return out;
}

}  // namespace

TEST(Drawing, a_cubic_in_svg_reads_back_to_its_control_points) {
    const std::vector<Vec<2>> c{{{0, 0}}, {{1, 2}}, {{3, 2.5}}, {{4, -0.25}}};
    const auto d = draw(with(bezier(c)));
    ASSERT_TRUE(d) << d.error().message;
    const auto paths = paths_in(to_svg(*d), "curve");
    ASSERT_EQ(paths.size(), 1u);
    EXPECT_EQ(std::ranges::count(paths[0], 'C'), 1);
    const auto x = numbers_of(paths[0]);
    ASSERT_EQ(x.size(), 8u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR((x[2 * i] - d->origin[0]) / d->scale, c[i][0], 1e-14);
        EXPECT_NEAR((d->origin[1] - x[2 * i + 1]) / d->scale, c[i][1], 1e-14);
    }
}

TEST(Drawing, lines_and_parabolas_are_exact_too) {
    const auto line = draw(with(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}})));
    const auto parabola = draw(with(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 0}}})));
    ASSERT_TRUE(line && parabola);
    EXPECT_EQ(group(*line, "curve")->paths[0].segments[0].degree, 1);
    const DrawnSegment& s = group(*parabola, "curve")->paths[0].segments[0];
    EXPECT_EQ(s.degree, 2);
    EXPECT_LT(norm(s.points[0] - pixel(*parabola, {{1, 2}})), 1e-9);
    EXPECT_EQ(std::ranges::count(paths_in(to_svg(*parabola), "curve")[0], 'Q'), 1);
}

TEST(Drawing, equal_weights_are_no_weights) {
    const std::vector<Vec<2>> c{{{0, 0}}, {{1, 2}}, {{3, 2.5}}, {{4, -0.25}}};
    std::vector<Hom<2>> h;
    for (const Vec<2>& p : c) h.push_back(weighted(p, 2));
    EXPECT_EQ(to_svg(*draw(with(bezier(h)))), to_svg(*draw(with(bezier(c)))));
}

TEST(Drawing, a_spline_is_drawn_by_its_bezier_pieces) {
    std::mt19937 rng(7);
    const auto c = test::random_patch<1, Vec<2>>(rng, {3}, 5);
    const auto d = draw(with(c));
    ASSERT_TRUE(d);
    const DrawnPath& path = group(*d, "curve")->paths.at(0);
    const auto breaks = c.basis().breaks();
    ASSERT_EQ(path.segments.size(), breaks.size() - 1);
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
        EXPECT_EQ(path.segments[i].degree, 3);
        EXPECT_LT(norm(path.segments[i].points[2] - pixel(*d, c(breaks[i + 1]))), 1e-9);
    }
}

TEST(Drawing, a_rational_circle_is_flattened_within_a_twentieth_of_a_pixel) {
    for (const double radius : {1.0, 1e-200, 1e200}) {
        const Vec<2> centre = radius * Vec<2>{{30, -20}};
        const auto c = circle(radius, centre);
        const auto d = draw(with(c));
        ASSERT_TRUE(d) << d.error().message;
        const DrawnGroup& g = *group(*d, "curve");
        double worst = 0;
        for (int i = 0; i <= 4000; ++i) worst = std::max(worst, distance(pixel(*d, c(i / 1000.0)), g));
        EXPECT_LE(worst, kDrawingTolerance);
        EXPECT_GT(worst, kDrawingTolerance / 50) << "far more segments than are needed";
        EXPECT_LT(g.paths[0].segments.size(), 400u);
    }
}

TEST(Drawing, high_degrees_are_flattened_within_the_tolerance) {
    std::mt19937 rng(11);
    for (int degree = 4; degree <= 12; degree += 4) {
        const auto polynomial = test::random_patch<1, Vec<2>>(rng, {degree}, 2);
        const auto rational = test::random_patch<1, Hom<2>>(rng, {degree}, 2);
        const auto check = [&](const auto& c) {
            const auto d = draw(with(c));
            ASSERT_TRUE(d) << d.error().message;
            expect_inside(*d);
            for (int i = 0; i <= 500; ++i) {
                const Interval on = c.domain()[0];
                const Vec<2> p = pixel(*d, c(on.lo + on.length() * i / 500));
                EXPECT_LE(distance(p, *group(*d, "curve")), kDrawingTolerance);
            }
        };
        check(polynomial);
        check(rational);
    }
}

TEST(Drawing, everything_is_inside_the_picture_and_aspect_is_kept) {
    std::mt19937 rng(3);
    DrawingOptions all;
    all.control = all.knots = all.comb = true;
    for (int i = 0; i < 20; ++i) {
        auto c = test::random_patch<1, Hom<2>>(rng, {1 + i % 6}, i % 4);
        all.construction = c.domain()[0].middle();
        all.width = 100 + 90 * i, all.height = 700;
        const auto d = draw(with(c), {}, all);
        ASSERT_TRUE(d) << d.error().message;
        expect_inside(*d);
        const std::string files = to_svg(*d);
        EXPECT_EQ(files.find("nan"), std::string::npos);
        EXPECT_EQ(files.find("inf"), std::string::npos);
    }
    const auto round = draw(with(circle(1, {})));
    const Box<2> box = [&] {
        Box<2> b;
        for (const DrawnSegment& s : group(*round, "curve")->paths[0].segments) b.add(s.points[0]);
        return b;
    }();
    EXPECT_NEAR(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], 0.2);
    EXPECT_NEAR(box.hi[1] - box.lo[1], 900 - 2 * 45, 0.5);
}

TEST(Drawing, a_curve_of_one_coordinate_is_a_graph) {
    const auto cubic = bezier<Vec<1>>({{{0}}, {{2}}, {{-1}}, {{1}}});
    const auto rational = bezier<Hom<1>>({{{0, 1}}, {{4, 2}}, {{-1, 1}}, {{0.5, 0.5}}});
    const auto check = [](const auto& c) {
        const auto d = draw(with(c));
        ASSERT_TRUE(d) << d.error().message;
        const DrawnGroup& g = *group(*d, "curve");
        if (g.paths[0].segments[0].degree == 1) {
            for (int i = 0; i <= 100; ++i)
                EXPECT_LE(distance(pixel(*d, {{i / 100.0, c(i / 100.0)[0]}}), g), kDrawingTolerance);
        } else {
            ASSERT_EQ(g.paths[0].segments.size(), 1u);
            EXPECT_LT(norm(g.paths[0].segments[0].points[1] - pixel(*d, {{2.0 / 3, -1}})), 1e-9);
        }
    };
    check(cubic);
    check(rational);
    const auto steps = *Curve<Vec<1>>::make({*BSplineBasis::make(0, {0, 1, 2})},
                                            Net<1, Vec<1>>({2}, {Vec<1>{{3}}, Vec<1>{{5}}}));
    const auto d = draw(with(steps));
    ASSERT_TRUE(d) << d.error().message;
    ASSERT_EQ(group(*d, "curve")->paths.size(), 2u) << "the function jumps";
    EXPECT_LT(norm(group(*d, "curve")->paths[1].start - pixel(*d, {{1, 5}})), 1e-9);
}

TEST(Drawing, closed_curves_are_closed_paths) {
    const auto c =
        *Curve<Vec<2>>::make({*BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5})},
                             Net<1, Vec<2>>({5}, {{{0, 0}}, {{2, 0}}, {{3, 1}}, {{1, 3}}, {{-1, 1}}}));
    DrawingOptions how;
    how.control = true;
    const auto d = draw(with(c), {}, how);
    ASSERT_TRUE(d);
    EXPECT_TRUE(group(*d, "curve")->paths.at(0).closed);
    EXPECT_TRUE(group(*d, "control")->paths.at(0).closed);
    EXPECT_EQ(paths_in(to_svg(*d), "curve").at(0).back(), 'Z');
}

TEST(Drawing, the_construction_ends_at_the_point_of_the_curve) {
    std::mt19937 rng(5);
    for (int degree = 1; degree <= 5; ++degree) {
        const auto c = test::random_patch<1, Hom<2>>(rng, {degree}, 3);
        DrawingOptions how;
        how.construction = c.domain()[0].lo + 0.37 * c.domain()[0].length();
        const auto d = draw(with(c), {}, how);
        ASSERT_TRUE(d);
        EXPECT_LT(norm(group(*d, "point")->discs.at(0).centre - pixel(*d, c(*how.construction))), 1e-9);
        EXPECT_EQ(std::ranges::count(d->groups, "construction", &DrawnGroup::role), degree);
        EXPECT_EQ(group(*d, "construction")->discs.size(), std::size_t(degree));
    }
    DrawingOptions outside;
    outside.construction = 1.5;
    const auto d = draw(with(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}})), {}, outside);
    ASSERT_FALSE(d);
    EXPECT_EQ(d.error().kind, RefusalKind::out_of_domain);
    EXPECT_NE(d.error().message.find("[0, 1]"), std::string::npos) << d.error().message;
}

TEST(Drawing, needles_of_a_circle_are_equal_and_normal) {
    DrawingOptions how;
    how.comb = true;
    const auto d = draw(with(circle(2, {{1, 1}})), {}, how);
    ASSERT_TRUE(d);
    const Vec<2> centre = pixel(*d, {{1, 1}});
    double length = 0;
    for (const DrawnPath& path : group(*d, "comb")->paths) {
        if (path.segments.size() != 1) continue;
        const Vec<2> needle = path.segments[0].points[0] - path.start, radius = path.start - centre;
        if (length == 0) length = norm(needle);
        EXPECT_NEAR(norm(needle), length, 1e-6);
        EXPECT_NEAR(cross(needle, radius), 0, 1e-6);
        EXPECT_GT(dot(needle, radius), 0) << "away from the centre";
    }
    EXPECT_GT(length, 20);
}

TEST(Drawing, marks_say_multiplicity_and_weight) {
    DrawingOptions how;
    how.knots = how.control = true;
    const auto d = draw(with(circle(1, {})), {}, how);
    ASSERT_TRUE(d);
    const auto& knots = group(*d, "knots")->discs;
    ASSERT_EQ(knots.size(), 5u);
    EXPECT_GT(knots[0].radius, knots[1].radius) << "3 knots and 2";
    EXPECT_LT(norm(knots[1].centre - pixel(*d, {{0, 1}})), 1e-9);
    const auto& points = group(*d, "control")->discs;
    ASSERT_EQ(points.size(), 9u);
    EXPECT_NEAR(std::pow(points[1].radius / points[0].radius, 2), std::sqrt(0.5), 1e-12);
}

TEST(Drawing, curves_in_space_are_projected_along_the_view) {
    const std::vector<Vec<3>> c{{{0, 0, 0}}, {{1, 5, 2}}, {{3, 6, 2.5}}, {{4, 7, -0.25}}};
    DrawingOptions how;
    how.view = *parse_view("front");
    const auto d = draw(with(bezier(c)), {}, how);
    ASSERT_TRUE(d);
    const DrawnSegment& s = group(*d, "curve")->paths[0].segments[0];
    for (std::size_t i = 1; i < 4; ++i)
        EXPECT_LT(norm(s.points[i - 1] - pixel(*d, {{c[i][0], c[i][2]}})), 1e-9);
}

TEST(Drawing, surfaces_are_drawn_by_isolines_through_their_knots) {
    std::mt19937 rng(2);
    const auto s = test::random_patch<2, Vec<3>>(rng, {3, 2}, 6);
    DrawingOptions how;
    how.control = true;
    how.view = *parse_view("top");
    how.hidden = HiddenLines::shown;
    const auto d = draw(with(s), {}, how);
    ASSERT_TRUE(d);
    expect_inside(*d);
    EXPECT_EQ(group(*d, "edges")->paths.size(), 4u);
    EXPECT_EQ(group(*d, "isolines")->paths.size(), 12u);
    EXPECT_EQ(group(*d, "control")->discs.size(), s.net().flat().size());
    // The first inner isoline begins where the first inner knot of u meets the start of v.
    const double u = s.basis(0).breaks()[1];
    const Vec<3> p = s(u, s.domain()[1].lo);
    EXPECT_LT(norm(group(*d, "isolines")->paths[0].start - pixel(*d, {{p[0], p[1]}})), 1e-9);
}

TEST(Drawing, loops_of_trimmed_surfaces_stay_within_the_tolerance) {
    std::mt19937 rng(4);
    const auto s = test::random_patch<2, Vec<3>>(rng, {3, 3}, 2);
    const auto on = s.domain();
    const Vec<2> middle{{on[0].middle(), on[1].middle()}};
    const CurveGeometry<2> loop =
        Conic<2>{ConicKind::ellipse, middle, {{0.4 * on[0].length(), 0}}, {{0, 0.3 * on[1].length()}}};
    const auto trimmed = TrimmedSurface::make(s, {{loop}});
    ASSERT_TRUE(trimmed);
    DrawingOptions how;
    how.view = *parse_view("top");
    how.hidden = HiddenLines::shown;
    const auto d = draw(with(*trimmed), {}, how);
    ASSERT_TRUE(d) << d.error().message;
    expect_inside(*d);
    for (int i = 0; i < 700; ++i) {
        const Vec<2> uv = jet<0>(loop, 2 * std::numbers::pi * i / 700).value();
        const Vec<3> p = s(uv[0], uv[1]);
        EXPECT_LE(distance(pixel(*d, {{p[0], p[1]}}), *group(*d, "edges")), kDrawingTolerance);
    }
}

TEST(Drawing, loops_on_flat_surfaces_bend_by_their_own_curvature) {
    const auto plane =
        *Surface<Vec<3>>::make({*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)},
                               Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}));
    const CurveGeometry<2> loop = Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{0.4, 0}}, {{0, 0.4}}};
    DrawingOptions how;
    how.view = *parse_view("top");
    how.hidden = HiddenLines::shown;
    const auto d = draw(with(*TrimmedSurface::make(plane, {{loop}})), {}, how);
    ASSERT_TRUE(d) << d.error().message;
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec<2> p = jet<0>(loop, 2 * std::numbers::pi * i / 3000).value();
        worst = std::max(worst, distance(pixel(*d, p), *group(*d, "edges")));
    }
    EXPECT_LE(worst, kDrawingTolerance);
    EXPECT_GT(worst, kDrawingTolerance / 20);
}

TEST(Drawing, volumes_and_triangles_have_edges) {
    std::mt19937 rng(6);
    const auto v = draw(with(test::random_patch<3, Vec<3>>(rng, {2, 1, 3}, 1)));
    ASSERT_TRUE(v);
    EXPECT_EQ(group(*v, "edges")->paths.size(), 12u);
    std::vector<std::array<double, 4>> ends;
    for (const DrawnPath& path : group(*v, "edges")->paths) {
        const DrawnSegment& last = path.segments.back();
        const Vec<2>& end = last.points[std::size_t(last.degree - 1)];
        ends.push_back({path.start[0], path.start[1], end[0], end[1]});
    }
    std::ranges::sort(ends);
    for (std::size_t i = 1; i < ends.size(); ++i) {
        double apart = 0;
        for (std::size_t k = 0; k < 4; ++k) apart = std::max(apart, std::abs(ends[i][k] - ends[i - 1][k]));
        EXPECT_GT(apart, 1e-6) << "an edge is drawn twice";
    }
    const auto t = *Triangle<Vec<2>>::make(2, {{{0, 0}}, {{1, 0}}, {{0, 1}}, {{2, 0}}, {{1, 1}}, {{0, 3}}});
    const auto d = draw(with(t));
    ASSERT_TRUE(d);
    const auto& paths = group(*d, "edges")->paths;
    ASSERT_EQ(paths.size(), 3u);
    EXPECT_LT(norm(paths[0].start - pixel(*d, {{2, 0}})), 1e-9) << "edge 0 from corner 2";
    EXPECT_LT(norm(paths[1].start - pixel(*d, {{0, 3}})), 1e-9);
    EXPECT_LT(norm(paths[2].start - pixel(*d, {{0, 0}})), 1e-9);
}

TEST(Drawing, four_coordinates_are_refused_by_name) {
    auto document = with(bezier<Vec<4>>({{{0, 0, 0, 0}}, {{1, 2, 3, 4}}}), "tesseract");
    const auto none = draw(document);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, RefusalKind::no_answer);
    EXPECT_NE(none.error().where.find("tesseract"), std::string::npos) << none.error().where;
    document.objects.push_back({"", bezier<Vec<2>>({{{0, 0}}, {{1, 2}}}), {}});
    const auto one = draw(document);
    ASSERT_TRUE(one);
    ASSERT_EQ(one->left_out.size(), 1u);
    EXPECT_NE(one->left_out[0].message.find("four coordinates"), std::string::npos);
    EXPECT_FALSE(draw(Document{}));
}

TEST(Drawing, a_point_is_drawn_in_the_middle) {
    const auto d = draw(with(bezier<Vec<2>>({{{5, 5}}, {{5, 5}}, {{5, 5}}})));
    ASSERT_TRUE(d) << d.error().message;
    expect_inside(*d);
    EXPECT_EQ(group(*d, "curve")->paths[0].start, (Vec<2>{{600, 450}}));
}

TEST(Drawing, names_are_escaped_in_svg) {
    const auto d = draw(with(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}}), "a<b>&\"c\""));
    ASSERT_TRUE(d);
    EXPECT_NE(to_svg(*d).find("<title>a&lt;b&gt;&amp;&quot;c&quot;</title>"), std::string::npos);
}

TEST(Drawing, scaling_by_a_power_of_two_changes_no_byte) {
    std::mt19937 rng(9);
    const auto c = test::random_patch<1, Hom<2>>(rng, {4}, 3);
    std::vector<Hom<2>> scaled(c.net().flat().begin(), c.net().flat().end());
    for (auto& p : scaled) p[0] *= 0x1p40, p[1] *= 0x1p40;
    const auto big = Curve<Hom<2>>::make(c.bases(), Net<1, Hom<2>>(c.net().extent(), scaled));
    DrawingOptions how;
    how.control = how.comb = how.knots = true;
    EXPECT_EQ(to_svg(*draw(with(c), {}, how)), to_svg(*draw(with(*big), {}, how)));
}

TEST(Drawing, options_out_of_range_are_refused) {
    const auto document = with(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}}));
    DrawingOptions how;
    how.width = 8;
    EXPECT_EQ(draw(document, {}, how).error().where, "size");
    how = {};
    how.margin = 0.7;
    EXPECT_EQ(draw(document, {}, how).error().where, "margin");
    how = {};
    how.construction = std::nan("");
    EXPECT_EQ(draw(document, {}, how).error().kind, RefusalKind::nonfinite);
    const std::array<std::size_t, 1> beyond{3};
    EXPECT_EQ(draw(document, beyond).error().where, "objects");
}
