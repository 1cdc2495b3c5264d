// Boundaries that nearly touch themselves in the parameter plane, or do within the tolerance of the file.
#include "support/bezier.hpp"
#include "support/solids.hpp"

#include <freiform/model/assemble.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

const Extrusion kParameterPlane{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};

// In the plane z = 0, whose points are their parameters.
Vec<3> on_plane(const Vec<2>& p) { return {{p[0], p[1], 0}}; }
Conic<2> circle_about(const Vec<2>& centre, double r) {
    return {ConicKind::ellipse, centre, {{r, 0}}, {{0, r}}};
}
CurveGeometry<3> on_plane(const Conic<2>& c) {
    return Conic<3>{ConicKind::ellipse, on_plane(c.centre), on_plane(c.x), on_plane(c.y)};
}
CurveGeometry<2> side_between(const Vec<2>& from, const Vec<2>& to) { return Line<2>{from, to - from}; }
CurveGeometry<3> side_between(const Vec<3>& from, const Vec<3>& to) { return Line<3>{from, to - from}; }

Model of_faces(Model m, const std::vector<std::vector<Coedge>>& loops) {
    Shell shell;
    for (const auto& loop : loops) {
        Face f;
        f.surface = kParameterPlane;
        f.loops = {{loop}};
        shell.faces.push_back({int(m.faces.size()), false});
        m.faces.push_back(f);
    }
    m.shells = {shell};
    m.bodies = {{{0}, false, "", {}}};
    return *make_model(std::move(m));
}

// Between a circle and one inside that touches it, from where they touch to the angle `to`.
Model sickle(double outer, double inner, double to) {
    Model m;
    const double from = -kPi / 2;
    const Conic<2> out = circle_about({}, outer), in = circle_about({{0, inner - outer}}, inner);
    const Vec<2> tip{{0, -outer}}, far_end = jet<0>(CurveGeometry<2>(out), to).value(),
                                   near_end = jet<0>(CurveGeometry<2>(in), to).value();
    for (const Vec<2>& p : {tip, far_end, near_end}) m.vertices.push_back({on_plane(p), 1e-7});
    m.edges.push_back({on_plane(out), false, {from, to}, 0, 1, 1e-7, ""});
    m.edges.push_back({side_between(on_plane(far_end), on_plane(near_end)), false, {0, 1}, 1, 2, 1e-7, ""});
    m.edges.push_back({on_plane(in), false, {from, to}, 0, 2, 1e-7, ""});
    return of_faces(std::move(m),
                    {{{0, false, out}, {1, false, side_between(far_end, near_end)}, {2, true, in}}});
}

TEST(Boundaries, that_touch_in_a_cusp_are_told_apart) {
    for (const double inner : {28.0, 26.0, 20.0})
        for (const double tolerance : {3.0, 1.6, 1.0, 0.5, 0.1, 0.01}) {
            const auto t = *tessellate(sickle(29, inner, 1), {.tolerance = tolerance});
            ASSERT_TRUE(t.refused.empty()) << inner << " " << tolerance << " " << t.refused[0].reason.message;
            EXPECT_LE(t.error_bound, tolerance);
            EXPECT_LT(t.mesh.triangles.size(), 2000u) << inner << " " << tolerance;
        }
}

// A square with a tiny side, and the curve of the next one begins beside its end.
TEST(Boundaries, edges_shorter_than_the_tolerance_of_the_file_become_points) {
    constexpr double kTiny = 1e-5;
    for (const double tolerance : {1e-3, 1e-6}) {
        Model m;
        const Vec<2> at[] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{1, 1 - kTiny}}, {{0, 1}}};
        const Vec<2> beside{{1, 1 - kTiny / 2}};  // where the curve of the last but one side begins
        for (const Vec<2>& p : at) m.vertices.push_back({on_plane(p), tolerance});
        std::vector<Coedge> loop;
        for (int i = 0; i < 5; ++i) {
            const int k = (i + 1) % 5;
            m.edges.push_back(
                {side_between(on_plane(at[i]), on_plane(at[k])), false, {0, 1}, i, k, tolerance, ""});
            loop.push_back({i, false, side_between(i == 3 ? beside : at[i], at[k])});
        }
        const auto t = *tessellate(of_faces(std::move(m), {loop}), {.tolerance = 0.01});
        if (tolerance < kTiny) {
            ASSERT_EQ(t.refused.size(), 1u);
            EXPECT_EQ(t.refused[0].reason.kind, RefusalKind::invalid);
            continue;
        }
        ASSERT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
        EXPECT_EQ(t.mesh.triangles.size(), 2u);
        EXPECT_EQ(t.mesh.points.size(), 4u);
        EXPECT_GE(t.boundary_gap, kTiny / 4);
        EXPECT_LE(t.boundary_gap, 2 * kTiny);
    }
}

// A square, and a closed edge in its loop that runs around a tiny circle within it.
TEST(Boundaries, closed_edges_within_the_tolerance_of_their_vertex_become_points) {
    for (const double tolerance : {1e-3, 1e-6}) {
        constexpr double kTiny = 1e-5;
        Model m;
        const Vec<2> at[] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
        std::vector<Coedge> loop;
        for (const Vec<2>& p : at) m.vertices.push_back({on_plane(p), tolerance});
        for (int i = 0; i < 4; ++i) {
            const int k = (i + 1) % 4;
            m.edges.push_back(
                {side_between(on_plane(at[i]), on_plane(at[k])), false, {0, 1}, i, k, tolerance, ""});
            loop.push_back({i, false, side_between(at[i], at[k])});
        }
        const Conic<2> round{ConicKind::ellipse, {{kTiny, kTiny}}, {{-kTiny, -kTiny}}, {{kTiny, -kTiny}}};
        m.edges.push_back({on_plane(round), false, {0, 2 * kPi}, 0, 0, tolerance, ""});
        loop.push_back({4, false, round});
        const auto t = *tessellate(of_faces(std::move(m), {loop}), {.tolerance = 0.01});
        EXPECT_EQ(t.refused.size(), tolerance < kTiny ? 1u : 0u);
        EXPECT_EQ(t.mesh.triangles.size(), tolerance < kTiny ? 0u : 2u);
        EXPECT_LE(t.boundary_gap, 4 * kTiny);
    }
}

// A square with a triangle cut out of it that touches the middle of the lower side, there `below` it in the
// parameter plane. `own`: the triangle has a vertex of its own for that.
Model touched_square(double tolerance, double below, bool own) {
    Model m;
    const std::vector<Vec<2>> outer{{{0, 0}}, {{0.5, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}},
        inner{{{0.5, 0}}, {{0.3, 0.4}}, {{0.7, 0.4}}};
    for (const Vec<2>& p : outer) m.vertices.push_back({on_plane(p), tolerance});
    for (const Vec<2>& p : inner) m.vertices.push_back({on_plane(p), tolerance});
    Face f;
    f.surface = kParameterPlane;
    f.tolerance = tolerance;
    for (const auto* polygon : {&outer, &inner}) {
        const int first = polygon == &outer ? 0 : int(outer.size()), n = int(polygon->size());
        Loop loop;
        for (int i = 0; i < n; ++i) {
            const int k = (i + 1) % n;
            const Vec<2> a = (*polygon)[std::size_t(i)], b = (*polygon)[std::size_t(k)];
            const auto vertex = [&](int at) { return first > 0 && at == 0 && !own ? 1 : first + at; };
            const auto place = [&](const Vec<2>& p) {
                return first > 0 && p[1] == 0 ? p - Vec<2>{{0, below}} : p;
            };
            loop.coedges.push_back({int(m.edges.size()), false, side_between(place(a), place(b))});
            m.edges.push_back(
                {side_between(on_plane(a), on_plane(b)), false, {0, 1}, vertex(i), vertex(k), tolerance, ""});
        }
        f.loops.push_back(loop);
    }
    m.faces = {f};
    m.shells = {{{{0, false}}}};
    m.bodies = {{{0}, false, "", {}}};
    return *make_model(std::move(m));
}

TEST(Boundaries, loops_that_touch_in_a_vertex_within_the_tolerance_have_it_at_one_place) {
    for (const double below : {1e-8, -1e-8}) {
        const auto t = *tessellate(touched_square(1e-6, below, false), {.tolerance = 0.01});
        ASSERT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
        EXPECT_EQ(t.mesh.points.size(), 7u);
        EXPECT_EQ(t.topology.open_edges, 8);
        EXPECT_GE(t.boundary_gap, 1e-8);
        EXPECT_LE(t.boundary_gap, 4e-8);
    }
    EXPECT_EQ(tessellate(touched_square(1e-9, 1e-8, false), {.tolerance = 0.01})->refused.size(), 1u);
}

TEST(Boundaries, two_vertices_at_one_place_are_one_point) {
    for (const double below : {0.0, 0x1p-54, -0x1p-54}) {
        const auto t = *tessellate(touched_square(1e-7, below, true), {.tolerance = 0.01});
        ASSERT_TRUE(t.refused.empty()) << below << t.refused[0].reason.message;
        EXPECT_EQ(t.mesh.points.size(), 7u) << below;
        EXPECT_EQ(t.topology.degenerate_triangles, 0) << below;
        EXPECT_EQ(t.topology.open_edges, 8) << below;
    }
}

// A square of which a corner is the tip of a spike without width that two of its sides run along; the second
// one `beside` it in the parameter plane. Or a face of the same edges whose boundary crosses itself, and
// after it that square, or a face on the other side of one of the two.
enum class Spiked { square, torn_and_square, torn_and_other_side };
constexpr double kSpike = 1e-5;
Model spiked(double tolerance, double beside, Spiked what) {
    const auto bent = [](const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
        return Curve<Vec<2>>::trusted({*BSplineBasis::make(1, std::vector{0., 0., 0.5, 1., 1.})},
                                      Net<1, Vec<2>>({3}, {a, b, c}));
    };
    const auto lifted = [](const Curve<Vec<2>>& c) {
        std::vector<Vec<3>> p;
        for (const Vec<2>& q : c.net().flat()) p.push_back(on_plane(q));
        return Curve<Vec<3>>::trusted(c.bases(), Net<1, Vec<3>>({3}, std::move(p)));
    };
    Model m;
    const Vec<2> tip{{0, -kSpike}}, corner{{0, 0}}, right{{1, 0}}, top{{1, 1}}, left{{0, 1}},
        other{{beside, 0}}, across{{-1, 0.5}};
    for (const Vec<2>& p : {tip, right, top, left}) m.vertices.push_back({on_plane(p), tolerance});
    const auto first = bent(tip, corner, right), last = bent(left, corner, tip);
    m.edges.push_back({lifted(first), false, {0, 1}, 0, 1, tolerance, ""});
    m.edges.push_back({side_between(on_plane(right), on_plane(top)), false, {0, 1}, 1, 2, tolerance, ""});
    m.edges.push_back({side_between(on_plane(top), on_plane(left)), false, {0, 1}, 2, 3, tolerance, ""});
    m.edges.push_back({lifted(last), false, {0, 1}, 3, 0, tolerance, ""});
    const auto loop = [&](const Vec<2>& third) {
        return std::vector<Coedge>{{0, false, first},
                                   {1, false, side_between(right, third)},
                                   {2, false, side_between(third, left)},
                                   {3, false, bent(left, other, tip)}};
    };
    std::vector<std::vector<Coedge>> loops;
    if (what != Spiked::square) loops.push_back(loop(across));
    if (what != Spiked::torn_and_other_side) loops.push_back(loop(top));
    if (what == Spiked::torn_and_other_side) {
        const Vec<2> low{{0.5, -1}};
        m.vertices.push_back({on_plane(low), tolerance});
        m.edges.push_back({side_between(on_plane(tip), on_plane(low)), false, {0, 1}, 0, 4, tolerance, ""});
        m.edges.push_back({side_between(on_plane(low), on_plane(right)), false, {0, 1}, 4, 1, tolerance, ""});
        loops.push_back(
            {{0, true, first}, {4, false, side_between(tip, low)}, {5, false, side_between(low, right)}});
    }
    return of_faces(std::move(m), loops);
}

// A square on a surface with a knot at v = 0; its side at u = 0 are these splines.
Tessellation square_beside_knot(const std::vector<CurveGeometry<2>>& side) {
    const auto line = *BSplineBasis::bezier(1);
    const auto square = *BSplineBasis::make(2, {-1, -1, -1, 0, 1, 1, 1});
    std::vector<Vec<3>> c;
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 4; ++k) c.push_back({{double(i), k - 1.5, k == 1 || k == 2 ? 0.3 : 0.0}});
    const auto surface = *Surface<Vec<3>>::make({line, square}, Net<2, Vec<3>>({2, 4}, c));
    const Vec<2> corner[] = {{{0, -1}}, {{1, -1}}, {{1, 1}}, {{0, 1}}};
    std::vector<std::vector<CurveGeometry<2>>> loops(1);
    for (int k = 0; k < 3; ++k)
        loops[0].push_back(*Curve<Vec<2>>::make({line}, Net<1, Vec<2>>({2}, {corner[k], corner[k + 1]})));
    loops[0].insert(loops[0].end(), side.begin(), side.end());
    ModelBuilder builder;
    EXPECT_TRUE(builder.add_trimmed(surface, loops));
    Model m = *std::move(builder).finish();
    for (Edge& e : m.edges) e.tolerance = 1e-6;
    return *tessellate(m, {.tolerance = 0.01});
}

// A side with corners at the knot and `beside`, nearer than the digits of a file: both are on the line of the
// knot, but not in one place.
TEST(Boundaries, that_have_two_corners_beside_a_knot_of_the_surface_keep_both) {
    for (const double beside : {5e-9, -5e-9, 1e-9, 1e-12}) {
        const double lo = std::min(0.0, beside), hi = std::max(0.0, beside);
        const auto t = square_beside_knot(
            {*Curve<Vec<2>>::make({*BSplineBasis::make(1, {-1, -1, -hi, -lo, 1, 1})},
                                  Net<1, Vec<2>>({4}, {{{0, 1}}, {{0.2, hi}}, {{0.2, lo}}, {{0, -1}}}))});
        ASSERT_TRUE(t.refused.empty()) << beside << " " << t.refused[0].reason.message;
        EXPECT_LE(t.error_bound, 0.01);
        EXPECT_LE(t.boundary_gap, 1e-6);
    }
}

// Likewise where one of them is a vertex.
TEST(Boundaries, that_have_a_vertex_and_a_corner_beside_a_knot_of_the_surface_keep_both) {
    for (const double beside : {5e-9, -5e-9, 1e-12})
        for (const bool before : {true, false}) {
            const double at = before ? -beside : beside;  // the vertex
            const Vec<2> from{{0, 1}}, corner{{0.2, 0}}, vertex{{0.2, at}}, to{{0, -1}};
            const auto two = *BSplineBasis::make(1, {0, 0, 0.5, 1, 1});
            const auto one = *BSplineBasis::bezier(1);
            const auto first = before
                                   ? *Curve<Vec<2>>::make({two}, Net<1, Vec<2>>({3}, {from, corner, vertex}))
                                   : *Curve<Vec<2>>::make({one}, Net<1, Vec<2>>({2}, {from, vertex}));
            const auto second = before
                                    ? *Curve<Vec<2>>::make({one}, Net<1, Vec<2>>({2}, {vertex, to}))
                                    : *Curve<Vec<2>>::make({two}, Net<1, Vec<2>>({3}, {vertex, corner, to}));
            const auto t = square_beside_knot({first, second});
            ASSERT_TRUE(t.refused.empty()) << at << " " << before << " " << t.refused[0].reason.message;
            EXPECT_LE(t.error_bound, 0.01);
            EXPECT_LE(t.boundary_gap, 1e-6);
        }
}

// What a face was given in vain another that needs it still gets, and no other has it.
TEST(Boundaries, that_cannot_be_mended_take_nothing_from_their_neighbours) {
    for (const double beside : {0.0, 1e-13, -1e-13}) {
        const auto t = *tessellate(spiked(1e-4, beside, Spiked::torn_and_square), {.tolerance = 0.01});
        ASSERT_EQ(t.refused.size(), 1u) << beside << " " << t.refused.back().reason.message;
        EXPECT_EQ(t.refused[0].face, 0);
        EXPECT_EQ(t.mesh.triangles.size(), 2u) << beside;
        EXPECT_EQ(t.topology.degenerate_triangles, 0) << beside;
        EXPECT_LE(t.boundary_gap, 2 * kSpike);
    }
    const auto t = *tessellate(spiked(1e-4, 0, Spiked::torn_and_other_side), {.tolerance = 0.01});
    ASSERT_EQ(t.refused.size(), 1u);
    EXPECT_EQ(t.mesh.triangles.size(), 2u);
    EXPECT_EQ(t.boundary_gap, 0);
}

// Two sides on one line whose parameter curves make a corner: the triangle there has no area in space.
TEST(Boundaries, that_are_straight_in_space_alone_have_no_triangle_without_area) {
    for (int i = 0; i < 20; ++i) {
        const double height = 1 << (i % 5), deep = 0.25 * (1 << (i / 5));
        Model m;
        const Vec<2> at[] = {{{0, 0}}, {{0.75, 0}}, {{2, 0}}, {{2, height}}, {{0, height}}},
                     bow{{0.75, -deep}};
        for (const Vec<2>& p : at) m.vertices.push_back({on_plane(p), 4.0});
        std::vector<Coedge> loop;
        for (int side = 0; side < 5; ++side) {
            const int k = (side + 1) % 5;
            m.edges.push_back(
                {side_between(on_plane(at[side]), on_plane(at[k])), false, {0, 1}, side, k, 4.0, ""});
            loop.push_back({side, false, side_between(side == 1 ? bow : at[side], k == 1 ? bow : at[k])});
        }
        const auto t = *tessellate(of_faces(std::move(m), {loop}), {.tolerance = 0.01});
        ASSERT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
        EXPECT_EQ(t.topology.degenerate_triangles, 0) << height << " " << deep;
        EXPECT_EQ(t.topology.open_edges, 5) << height << " " << deep;
        EXPECT_NEAR(t.boundary_gap, deep, 1e-9);
    }
}

// Curves that cross do so however often they are cut; the face beside pays nothing for it.
TEST(Boundaries, that_cross_are_refused_and_leave_no_cuts_behind) {
    Model m;
    const Vec<2> at[] = {{{0, 0}}, {{2, 0}}, {{2, 1}}, {{0, 1}}}, tie[] = {at[0], at[2], at[1], at[3]};
    for (const Vec<2>& p : at) m.vertices.push_back({on_plane(p), 1e-7});
    std::vector<Coedge> bad, good;
    for (int i = 0; i < 4; ++i) {
        const int k = (i + 1) % 4;
        m.edges.push_back({side_between(on_plane(at[i]), on_plane(at[k])), false, {0, 1}, i, k, 1e-7, ""});
        good.push_back({i, false, side_between(at[i], at[k])});
        bad.push_back({i, false, side_between(tie[i], tie[k])});
    }
    const auto t = *tessellate(of_faces(std::move(m), {bad, good}), {.tolerance = 1e-3});
    ASSERT_EQ(t.refused.size(), 1u);
    EXPECT_EQ(t.refused[0].face, 0);
    EXPECT_EQ(t.mesh.triangles.size(), 2u);
}

// A sharp tip whose edges cross before they meet, up to 0.0044 apart behind that, and the faces on both
// sides.
Model crossed_tip(double tolerance) {
    Model m;
    const Vec<2> at[] = {{{0, 1}}, {{0, -1}}, {{10, 0}}, {{0, 5}}, {{10, 5}}, {{10, -5}}, {{0, -5}}};
    for (const Vec<2>& p : at) m.vertices.push_back({on_plane(p), tolerance});
    std::vector<std::vector<Coedge>> loops(3);
    const auto curved = [&](int from, double side, int above) {  // to the tip
        const std::vector<Vec<2>> p{at[from], {{10 / 3.0, 0.3 * side}}, {{20 / 3.0, -0.03 * side}}, at[2]};
        const std::vector<Vec<3>> q{on_plane(p[0]), on_plane(p[1]), on_plane(p[2]), on_plane(p[3])};
        loops[0].push_back({int(m.edges.size()), above == 1, bezier(p)});
        loops[std::size_t(above)].push_back({int(m.edges.size()), above == 2, bezier(p)});
        m.edges.push_back({bezier(q), false, {0, 1}, from, 2, tolerance, ""});
    };
    const auto straight = [&](int face, int from, int to) {
        loops[std::size_t(face)].push_back({int(m.edges.size()), false, side_between(at[from], at[to])});
        m.edges.push_back(
            {side_between(on_plane(at[from]), on_plane(at[to])), false, {0, 1}, from, to, tolerance, ""});
    };
    curved(1, -1, 2), curved(0, 1, 1), straight(0, 0, 1);
    straight(1, 2, 4), straight(1, 4, 3), straight(1, 3, 0);
    straight(2, 1, 6), straight(2, 6, 5), straight(2, 5, 2);
    return of_faces(std::move(m), loops);
}

// Between an arc and two lines above it, whose chord at a coarse tolerance is above both; and a face below
// the arc, which has the chord, too.
TEST(Boundaries, chords_turn_no_face_over) {
    Model m;
    const Vec<2> at[] = {{{0, 0}}, {{10, 0}}, {{5, -0.1}}, {{0, -5}}, {{10, -5}}};
    for (const Vec<2>& p : at) m.vertices.push_back({on_plane(p), 1e-7});
    const std::vector<Vec<2>> arc{at[0], {{5, -0.4}}, at[1]};
    m.edges.push_back({bezier(std::vector{on_plane(arc[0]), on_plane(arc[1]), on_plane(arc[2])}),
                       false,
                       {0, 1},
                       0,
                       1,
                       1e-7,
                       ""});
    std::vector<std::vector<Coedge>> loops{{{0, false, bezier(arc)}}, {{0, true, bezier(arc)}}};
    const auto side = [&](std::size_t face, int from, int to) {
        loops[face].push_back({int(m.edges.size()), false, side_between(at[from], at[to])});
        m.edges.push_back(
            {side_between(on_plane(at[from]), on_plane(at[to])), false, {0, 1}, from, to, 1e-7, ""});
    };
    side(0, 1, 2), side(0, 2, 0), side(1, 0, 3), side(1, 3, 4), side(1, 4, 1);
    const Model model = of_faces(std::move(m), loops);
    for (const double tolerance : {1.0, 0.3, 0.1, 0.01}) {
        const auto t = *tessellate(model, {.tolerance = tolerance});
        ASSERT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
        EXPECT_EQ(t.topology.open_edges, 5) << tolerance;
        EXPECT_EQ(t.topology.misoriented_edges + t.topology.non_manifold_edges, 0) << tolerance;
    }
}

// The face ends where they cross; what is behind that closes the mesh. All together is a rectangle, whose
// area counts triangles that are turned over as what they are.
TEST(Boundaries, that_cross_within_the_tolerance_of_the_file_before_they_meet_are_closed) {
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
        const auto t = *tessellate(crossed_tip(0.002), {.tolerance = tolerance});
        ASSERT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
        EXPECT_LE(t.error_bound, tolerance);
        EXPECT_GT(t.boundary_gap, 1e-3) << tolerance;
        EXPECT_LT(t.boundary_gap, 0.008) << tolerance;
        EXPECT_EQ(t.topology.degenerate_triangles, 0);
        EXPECT_EQ(t.topology.misoriented_edges + t.topology.non_manifold_edges, 0);
        EXPECT_EQ(t.topology.open_edges, 7);
        double area = 0;
        for (std::size_t i = 0; i < t.mesh.triangles.size(); ++i) {
            const auto c = t.mesh.points_of(i);
            const auto p = [&](std::size_t k) { return t.mesh.points[std::size_t(c[k])]; };
            area += cross(p(1) - p(0), p(2) - p(0))[2] / 2;
        }
        EXPECT_NEAR(area, 100, 1e-9);
    }
}

TEST(Boundaries, that_cross_by_more_than_the_tolerance_of_the_file_stay_refused) {
    const auto t = *tessellate(crossed_tip(1e-4), {.tolerance = 1e-4});
    ASSERT_EQ(t.refused.size(), 1u);
    EXPECT_EQ(t.refused[0].face, 0);
    std::size_t alone = 0;
    for (const int f : {1, 2}) {
        Model one = crossed_tip(1e-4);
        one.faces = {one.faces[std::size_t(f)]};
        one.shells[0].faces = {{0, false}};
        alone += tessellate(*make_model(std::move(one)), {.tolerance = 1e-4})->mesh.triangles.size();
    }
    EXPECT_EQ(t.mesh.triangles.size(), alone);
}

}  // namespace
