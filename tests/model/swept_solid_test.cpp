#include "random.hpp"
#include "refusal.hpp"
#include "solids.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/model/swept_solid.hpp>

namespace freiform::test {
namespace {

Subpath square_loop(Vec<2> lo, double side) {
    const Vec<2> p[4] = {lo, lo + Vec<2>{{side, 0}}, lo + Vec<2>{{side, side}}, lo + Vec<2>{{0, side}}};
    Subpath s{p[0], {}, true};
    for (std::size_t i = 0; i < 4; ++i) s.segments.push_back({1, {p[i], p[(i + 1) % 4]}, 1});
    return s;
}

// A square of side 4 with a hole of side 2 and an island of side 1 in the hole, and a circle of radius 1
// beside them; the directions of the loops are any.
RegionLoops four_loops() {
    return loops_of({{square_loop({{0, 0}}, 4), square_loop({{1, 1}}, 2), square_loop({{1.5, 1.5}}, 1),
                      ellipse({{6, 2}}, 1, 1)}});
}
constexpr double kAreaOfFour = 16 - 4 + 1 + kPi;

Tessellation closed_mesh(const Result<Model>& model, double tolerance) {
    EXPECT_TRUE(model) << model.error().where << ": " << model.error().message;
    if (!model) return {};
    return closed_tessellation(*model, tolerance);
}

TEST(Prism, has_the_volume_of_its_region_times_its_height) {
    for (const Vec<3> by : {Vec<3>{{0, 0, 3}}, Vec<3>{{0, 0, -3}}, Vec<3>{{2, -1, 3}}, Vec<3>{{1, 1, -3}}}) {
        const auto model = prism(four_loops(), by);
        const Tessellation t = closed_mesh(model, 1e-4);
        EXPECT_NEAR(signed_volume(t.mesh), 3 * kAreaOfFour, 1e-2) << by[2];
        ASSERT_TRUE(model);
        EXPECT_EQ(model->bodies.size(), 3u);  // the island and the circle are apart
        for (const Body& b : model->bodies) EXPECT_TRUE(b.solid);
        EXPECT_EQ(model->faces.size(), 4 + 4 + 4 + 1 + 6u);
    }
}

TEST(Prism, edges_keep_the_points_of_the_region_to_the_bit) {
    Path path{{square_loop({{0.1, 0.2}}, 0.3)}};
    path.subpaths[0].segments[0] = {
        3, {path.subpaths[0].start, {{0.2, 0.1}}, {{0.25, 0.15}}, {{0.4, 0.2}}}, 1};
    const auto model = prism(loops_of(path), {{0, 0, 1}});
    ASSERT_TRUE(model);
    int found = 0;
    for (const Edge& e : model->edges)
        if (const auto* c = e.curve ? std::get_if<Curve<Vec<3>>>(&*e.curve) : nullptr)
            found += c->net().flat()[1] == Vec<3>{{0.2, 0.1, 0}};
    EXPECT_EQ(found, 1);
    EXPECT_LT(closed_mesh(model, 1e-3).boundary_gap, 1e-15);
}

TEST(Prism, of_a_single_closed_spline_has_a_seam) {
    const Curve<Vec<2>> drop = Curve<Vec<2>>::trusted(
        {*BSplineBasis::bezier(3)}, Net<1, Vec<2>>({4}, {{{0, 0}}, {{3, 1}}, {{-1, 3}}, {{0, 0}}}));
    const Tessellation t = closed_mesh(prism({{drop}}, {{0, 0, 2}}), 1e-4);
    EXPECT_GT(signed_volume(t.mesh), 0.1);
}

// Pappus: the area times the way of its centroid.
TEST(SolidOfRevolution, has_the_volume_that_pappus_says) {
    const RegionLoops region = four_loops();
    const double moment = 16 * 2 - 4 * 2 + 1 * 2 + kPi * 6;  // about x = 0
    for (const double angle : {2 * kPi, 1.0})
        for (const double x : {-1.0, 9.0})  // axes on both sides
            for (const double up : {3.0, -0.5}) {
                const auto model = solid_of_revolution(region, {{{x, 7, 0}}, {{0, up, 0}}}, angle);
                const Tessellation t = closed_mesh(model, 3e-2);
                const double expected = angle * std::abs(moment - x * kAreaOfFour);
                EXPECT_NEAR(signed_volume(t.mesh), expected, 2e-2 * expected)
                    << angle << ' ' << x << ' ' << up;
                ASSERT_TRUE(model);
                EXPECT_EQ(model->bodies.size(), 3u);
                EXPECT_EQ(model->shells.size(), angle > 6 ? 4u : 3u) << "the hole of a full turn is a void";
            }
    // About an axis that is oblique in the plane.
    const Axis oblique{{{-4, -4, 0}}, {{1, -1, 0}}};
    const double distance = (2 + 4 + 2 + 4) / std::sqrt(2.0);
    const Tessellation t =
        closed_mesh(solid_of_revolution(loops_of({{square_loop({{0, 0}}, 4)}}), oblique, 2 * kPi), 3e-2);
    EXPECT_NEAR(signed_volume(t.mesh), 16 * 2 * kPi * distance, 6);
}

Subpath polygon_loop(const std::vector<Vec<2>>& p) {
    Subpath s{p[0], {}, true};
    for (std::size_t i = 0; i < p.size(); ++i) s.segments.push_back({1, {p[i], p[(i + 1) % p.size()]}, 1});
    return s;
}
// Quarters of circles about the origin from angle to angle, counted in quarters, as rational arcs.
void add_arc(Subpath& s, double radius, int from, int to) {
    const auto at = [&](int k) {
        return Vec<2>{{radius * std::array{1, 0, -1, 0}[std::size_t(k & 3)],
                       radius * std::array{0, 1, 0, -1}[std::size_t(k & 3)]}};
    };
    for (int k = from; k != to; k += to > from ? 1 : -1) {
        const Vec<2> a = at(k), b = at(k + (to > from ? 1 : -1));
        s.segments.push_back({2, {a, a + b, b}, std::sqrt(0.5)});
    }
}

// Region, area times the distance of its centroid from x = 0, shells of a full turn, faces of a full turn.
struct OnAxis {
    std::string_view name;
    Subpath loop;
    double moment;
    std::size_t shells, walls;
};
std::vector<OnAxis> regions_on_axis() {
    std::vector<OnAxis> out;
    out.push_back({"cylinder", square_loop({{0, 0}}, 2), 4 * 1, 1, 3});
    out.push_back({"double cone", polygon_loop({{{0, 0}}, {{1, 1}}, {{0, 3}}}), 1.5 * (1 / 3.0), 1, 2});
    Subpath ball{{{0, -2}}, {}, true};
    add_arc(ball, 2, -1, 1);
    out.push_back({"ball", ball, 2.0 / 3 * 8, 1, 1});
    Subpath hollow = ball;
    hollow.segments.push_back({1, {Vec<2>{{0, 2}}, Vec<2>{{0, 1}}}, 1});
    add_arc(hollow, 1, 1, -1);
    out.push_back({"hollow ball", hollow, 2.0 / 3 * 7, 2, 2});
    // From the axis and back to the same point of it; to two points of it, and lines on it in between.
    out.push_back({"tip", polygon_loop({{{0, 0}}, {{2, -1}}, {{2, 1}}}), 2 * (4 / 3.0), 1, 3});
    out.push_back(
        {"comb",
         polygon_loop({{{0, 0}}, {{3, 0}}, {{3, 5}}, {{0, 5}}, {{1, 4}}, {{0, 3}}, {{0, 2}}, {{1, 1}}}),
         15 * 1.5 - 2 * (1 * 1 / 3.0), 3, 7});
    return out;
}

TEST(SolidOfRevolution, of_regions_that_reach_the_axis_have_poles_and_hollows_along_it) {
    for (const OnAxis& r : regions_on_axis())
        for (const bool left : {false, true})
            for (const double angle : {2 * kPi, 1.0})
                for (const double turned : {0.0, 0.7}) {
                    const double c = std::cos(turned), s = std::sin(turned);
                    const Path path =
                        transformed({{r.loop}}, {{{{left ? -c : c, -s}, {left ? -s : s, c}}}, {{3, -1}}});
                    const auto model =
                        solid_of_revolution(loops_of(path), {{{3, -1, 0}}, {{-s, c, 0}}}, angle);
                    const std::string which = std::string(r.name) + (left ? " left " : " right ") +
                                              std::to_string(angle) + " " + std::to_string(turned);
                    const Tessellation t = closed_mesh(model, 1e-2);
                    EXPECT_NEAR(signed_volume(t.mesh), angle * r.moment, 1.5e-2 * angle * r.moment) << which;
                    EXPECT_LE(t.boundary_gap, 1e-14) << which;
                    ASSERT_TRUE(model) << which;
                    ASSERT_EQ(model->bodies.size(), 1u) << which;
                    EXPECT_TRUE(model->bodies[0].solid);
                    EXPECT_EQ(model->bodies[0].shells.size(), angle > 6 ? r.shells : 1u) << which;
                    EXPECT_EQ(model->faces.size(), r.walls + (angle > 6 ? 0u : 2u)) << which;
                    // What goes round everything is first.
                    Box<3> outer, all;
                    for (const FaceUse& f : model->shells[std::size_t(model->bodies[0].shells[0])].faces)
                        for (const MeshPart& p : t.mesh.parts)
                            if (p.face == f.face)
                                for (int k = p.first; k < p.first + p.count; ++k)
                                    for (const int v : t.mesh.points_of(std::size_t(k)))
                                        outer.add(t.mesh.points[std::size_t(v)]);
                    for (const Vec<3>& p : t.mesh.points) all.add(p);
                    EXPECT_EQ(outer, all) << which;
                }
}

// The kinds of all faces and edges, in alphabetical order.
std::string kinds(const Result<Model>& model) {
    if (!model) return model.error().message;
    std::vector<std::string> names;
    for (const Face& f : model->faces) names.emplace_back(kind_name(f.surface));
    std::ranges::sort(names);
    const auto faces = names.size();
    for (const Edge& e : model->edges) names.emplace_back(e.curve ? kind_name(*e.curve) : "pole");
    std::sort(names.begin() + std::ptrdiff_t(faces), names.end());
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) out += (i == 0 ? "" : i == faces ? " | " : " ") + names[i];
    return out;
}

TEST(SweptSolid, lines_and_circles_are_called_so_and_sweep_elementary_surfaces) {
    const RegionLoops ring = loops_of({{square_loop({{-3, -3}}, 6), ellipse({{0, 0}}, 1, 1)}});
    const std::string walls =
        "cylinder plane plane plane plane plane plane | circle circle line line line line "
        "line line line line line line line line line";
    for (const double z : {2.0, -2.0}) EXPECT_EQ(kinds(prism(ring, {{0, 0, z}})), walls) << z;
    EXPECT_EQ(kinds(prism(loops_of({{ellipse({{0, 0}}, 1, 1)}}), {{1, 0, 2}})),
              "extrusion plane plane | circle circle line");
    EXPECT_EQ(kinds(prism(loops_of({{ellipse({{0, 0}}, 1, 2)}}), {{0, 0, 2}})).find("circle"),
              std::string::npos);
    const auto turned = [](const RegionLoops& region, double angle) {
        return kinds(solid_of_revolution(region, {{}, {{0, 1, 0}}}, angle));
    };
    const std::string expected[][2] = {
        {"cylinder plane plane | circle circle line",
         "cylinder plane plane plane plane | circle circle line line line line line line line"},
        {"cone cone | circle line line pole pole",
         "cone cone plane plane | circle line line line line line pole pole"},
        {"sphere | circle pole pole", "plane plane sphere | circle circle line pole pole"},
        {"sphere sphere | circle circle pole pole pole pole",
         "plane plane sphere sphere | circle circle circle circle line line pole pole pole pole"}};
    const auto regions = regions_on_axis();
    for (std::size_t i = 0; i < 4; ++i)
        for (const std::size_t part : {0u, 1u})
            EXPECT_EQ(turned(loops_of({{regions[i].loop}}), part ? 1 : 2 * kPi), expected[i][part])
                << regions[i].name;
    const RegionLoops tube = loops_of({{ellipse({{-5, 2}}, 1, 1)}});
    EXPECT_EQ(turned(tube, 2 * kPi), "torus | circle circle");
    EXPECT_EQ(turned(tube, 1), "plane plane torus | circle circle circle");
    const Vec<2> low{{0, -1}}, high_end{{0, 1}};
    const Subpath lens{low, {{2, {low, Vec<2>{{1, 0}}, high_end}, std::sqrt(0.5)}}, true};
    EXPECT_EQ(turned(loops_of({{lens}}), 2 * kPi), "revolution | nurbs pole pole")
        << "a circle beyond the axis";
    // Higher degrees of the same curves, and circles in one piece.
    RegionLoops high = loops_of({{regions[2].loop}});
    for (auto& curve : high[0])
        curve = visit_one(
            [](const auto& c) -> CurveGeometry<2> {
                if constexpr (requires { c.net(); }) return must(elevate(c, 0, 2));
                return c;
            },
            curve);
    EXPECT_EQ(turned(high, 2 * kPi), expected[2][0]);
}

// What is nearly a circle, in its weights or its points, is a spline.
TEST(SweptSolid, splines_that_are_no_circles_stay_what_they_are) {
    for (const double off : {1e-9, -1e-5}) {
        Path heavy{{ellipse({{0, 0}}, 1, 1)}}, moved = heavy;
        for (PathSegment& s : heavy.subpaths[0].segments) s.weight += off;
        for (PathSegment& s : moved.subpaths[0].segments) s.points[1][0] += off;
        for (const Path& path : {heavy, moved}) {
            const auto model = prism(loops_of(path), {{0, 0, 1}});
            EXPECT_EQ(kinds(model).find("circle"), std::string::npos) << kinds(model);
        }
    }
    // Arcs on one circle that a line follows; and back again on the same circle.
    Subpath s{{{1, 0}}, {}, true};
    add_arc(s, 1, 0, 2);
    s.segments.push_back({1, {Vec<2>{{-1, 0}}, Vec<2>{{-0.5, 0}}}, 1});
    add_arc(s, 0.5, 2, 0);
    EXPECT_EQ(kinds(prism(loops_of({{s}}), {{0, 0, 1}})),
              "cylinder cylinder plane plane plane plane | circle circle circle circle line line line line "
              "line line line line");
    const Tessellation t = closed_mesh(prism(loops_of({{s}}), {{0, 0, -1}}), 1e-5);
    EXPECT_NEAR(signed_volume(t.mesh), kPi / 2 * (1 - 0.25), 1e-4);
}

TEST(SweptSolid, open_subpaths_are_closed_and_dots_left_out) {
    const Subpath dot{{{5, 5}}, {}, true}, still{{{6, 6}}, {{1, {{{{6, 6}}, {{6, 6}}}}, 1}}, true};
    Path path{{square_loop({{0, 0}}, 1), dot, still}};
    path.subpaths[0].segments.pop_back();
    path.subpaths[0].closed = false;
    const RegionLoops loops = loops_of(path);
    ASSERT_EQ(loops.size(), 1u);
    EXPECT_EQ(loops[0].size(), 4u);
    EXPECT_NEAR(signed_volume(closed_mesh(prism(loops, {{0, 0, 1}}), 1e-3).mesh), 1, 1e-14);
}

TEST(SweptSolid, scales_exactly_with_powers_of_two) {
    const auto volumes = [](double scale) {
        const Path path = transformed({{square_loop({{0, 0}}, 4), ellipse({{2, 2}}, 1, 1)}},
                                      {{{{scale, 0}, {0, scale}}}, {}});
        const Axis axis{{{-scale / 8, 0, 0}}, {{0, 1, 0}}};
        const auto volume = [&](const Result<Model>& model) {
            return signed_volume(must(tessellate(must(model), {.tolerance = 0.0625 * scale})).mesh);
        };
        return std::array{volume(prism(loops_of(path), {{0, 0, scale}})),
                          volume(solid_of_revolution(loops_of(path), axis, 1))};
    };
    const auto one = volumes(1), small = volumes(0x1p-60);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(small[i], one[i] * 0x1p-180);
}

TEST(SweptSolid, refuses_what_sweeps_no_solid) {
    const RegionLoops region = four_loops();
    expect_refusal(prism(region, {{1, 1, 0}}), RefusalKind::invalid, "by");
    expect_refusal(prism(region, {{0, 0, kInfinity}}), RefusalKind::invalid, "by");
    expect_refusal(prism({}, {{0, 0, 1}}), RefusalKind::no_answer, "loops");
    const auto crossing =
        prism(loops_of({{square_loop({{0, 0}}, 2), square_loop({{1, 1}}, 2)}}), {{0, 0, 1}});
    ASSERT_FALSE(crossing);
    EXPECT_TRUE(crossing.error().where.starts_with("loops[0]")) << crossing.error().where;
    EXPECT_NE(crossing.error().message.find("crosses"), std::string::npos);
    const CurveGeometry<2> round = Conic<2>{ConicKind::ellipse, {}, {{1, 0}}, {{0, 1}}};
    expect_refusal(prism({{round}}, {{0, 0, 1}}), RefusalKind::unsupported, "loops[0][0]");
    expect_refusal(solid_of_revolution(region, {{{2, 0, 0}}, {{0, 1, 0}}}, 1), RefusalKind::unsupported,
                   "axis", "both sides");
    const Vec<2> low{{1, 0}}, high{{1, 3}};
    const Subpath bulge{
        low, {{3, {low, Vec<2>{{0, 1}}, Vec<2>{{0, 2}}, high}, 1}, {1, {high, Vec<2>{{2, 1}}}, 1}}, true};
    expect_refusal(solid_of_revolution(loops_of({{bulge}}), {{}, {{0, 1, 0}}}, 1), RefusalKind::unsupported,
                   "loops[0][0]", "between its ends");
    expect_refusal(solid_of_revolution({}, {{}, {{0, 1, 0}}}, 1), RefusalKind::no_answer, "loops");
    expect_refusal(solid_of_revolution(region, {{{-1, 0, 0}}, {{0, 1, 1}}}, 1), RefusalKind::invalid, "axis");
    expect_refusal(solid_of_revolution(region, {{{-1, 0, 0}}, {{0, 0, 0}}}, 1), RefusalKind::invalid, "axis");
    expect_refusal(solid_of_revolution(region, {{{-1, 0, 0}}, {{0, 1, 0}}}, 7), RefusalKind::invalid,
                   "angle");
    expect_refusal(solid_of_revolution(region, {{{-1, 0, 0}}, {{0, 1, 0}}}, 0), RefusalKind::invalid,
                   "angle");
}

}  // namespace
}  // namespace freiform::test
