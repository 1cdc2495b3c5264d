// Loose faces joined: cubes with every side drawn anew, edges of other speed, cut otherwise, of wrong
// direction, and what must not be joined.
#include "support/sewn.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/model/edge_gap.hpp>
#include <freiform/model/sew.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

using namespace freiform;
using namespace freiform::test;

namespace {

// A bilinear face with its own vertices and edges, its edges cut into `parts` each, moved by up to `noise`.
struct Patchwork {
    Model m;
    Random rng{3};
    double noise = 0;

    Vec<3> moved(Vec<3> p) {
        for (int i = 0; i < 3; ++i) p[i] += noise * rng.real(-0.5, 0.5);
        return p;
    }
    // corners: (0, 0), (1, 0), (0, 1), (1, 1). `cuts`: inner parameters of each side, in the order of the
    // loop.
    int add(std::array<Vec<3>, 4> c, std::array<std::vector<double>, 4> cuts = {}) {
        for (Vec<3>& p : c) p = moved(p);
        const auto linear = *BSplineBasis::bezier(1);
        Face f;
        f.surface =
            *Surface<Vec<3>>::make({linear, linear}, Net<2, Vec<3>>({2, 2}, {c[0], c[2], c[1], c[3]}));
        const Vec<2> uv[4] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
        const int first = int(m.vertices.size());
        Loop loop;
        int count = 0;
        for (int side = 0; side < 4; ++side) {
            std::vector<double> t{0};
            t.insert(t.end(), cuts[std::size_t(side)].begin(), cuts[std::size_t(side)].end());
            t.push_back(1);
            count += int(t.size()) - 1;
        }
        int k = 0;
        for (int side = 0; side < 4; ++side) {
            std::vector<double> t{0};
            t.insert(t.end(), cuts[std::size_t(side)].begin(), cuts[std::size_t(side)].end());
            t.push_back(1);
            const Vec<2> from = uv[side], to = uv[(side + 1) % 4];
            const auto at = [&](double x) { return Vec<2>((1 - x) * from + x * to); };
            for (std::size_t i = 0; i + 1 < t.size(); ++i, ++k) {
                const Vec<2> a = at(t[i]), b = at(t[i + 1]);
                const Vec<3> p = jet<0>(f.surface, a.c).value(), q = jet<0>(f.surface, b.c).value();
                m.vertices.push_back({p, 0});
                m.edges.push_back(
                    {Line<3>{p, q - p}, false, {0, 1}, first + k, first + (k + 1) % count, 0, ""});
                loop.coedges.push_back({int(m.edges.size()) - 1, false, segment({0, 1}, a, b)});
            }
        }
        f.loops = {loop};
        f.name = "face " + std::to_string(m.faces.size());
        m.faces.push_back(std::move(f));
        return int(m.faces.size()) - 1;
    }
    Model model() {
        Shell shell;
        for (std::size_t f = 0; f < m.faces.size(); ++f) shell.faces.push_back({int(f), false});
        m.shells = {shell};
        m.bodies = {{{0}, false, "", {}}};
        return *make_model(m);
    }
};

Vec<3> corner(int i) { return {{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)}}; }

Model loose_cube(double noise, bool turned = false) {
    Patchwork p;
    p.noise = noise;
    const int quads[6][4] = {{0, 2, 1, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                             {2, 6, 3, 7}, {0, 4, 2, 6}, {1, 3, 5, 7}};
    for (int i = 0; i < 6; ++i) {
        auto q = quads[i];
        if (turned && i % 2)
            p.add({corner(q[0]), corner(q[2]), corner(q[1]), corner(q[3])});
        else
            p.add({corner(q[0]), corner(q[1]), corner(q[2]), corner(q[3])});
    }
    return p.model();
}

TEST(Sew, loose_sides_become_a_cube) {
    for (const double noise : {0.0, 1e-9, 1e-4}) {
        const Model loose = loose_cube(noise);
        EXPECT_EQ(summary(loose).open_edges, 24);
        const auto s = sew(loose, {.tolerance = std::max(4 * noise, 1e-12)});
        ASSERT_TRUE(s);
        expect_sound(*s, loose);
        EXPECT_EQ(s->open_before, 24);
        EXPECT_EQ(s->joined.size(), 12u);
        EXPECT_EQ(s->vertices_joined, 16);
        EXPECT_LE(s->vertex_moved, 2 * noise);
        EXPECT_TRUE(s->flipped.empty());
        EXPECT_TRUE(s->model.bodies[0].solid && s->model.shells[0].closed);
        const auto t = tessellate(s->model, {.tolerance = 0.01});
        ASSERT_TRUE(t);
        EXPECT_EQ(t->mesh.triangles.size(), 12u);
        EXPECT_EQ(t->topology.open_edges + t->topology.misoriented_edges + t->topology.non_manifold_edges, 0);
        EXPECT_LE(t->boundary_gap, 2 * noise + 1e-14);
        EXPECT_NEAR(std::abs(signed_volume(t->mesh)), 1, 8 * noise + 1e-12);
    }
}

TEST(Sew, faces_that_look_the_wrong_way_are_turned_over) {
    const Model loose = loose_cube(0, true);
    const auto s = sew(loose, {.tolerance = 1e-6});
    ASSERT_TRUE(s);
    expect_sound(*s, loose);
    EXPECT_EQ(s->flipped.size(), 3u);
    EXPECT_TRUE(s->twisted.empty());
    const auto t = tessellate(s->model, {.tolerance = 0.01});
    EXPECT_EQ(t->topology.misoriented_edges, 0);
    EXPECT_NEAR(std::abs(signed_volume(t->mesh)), 1, 1e-12);
}

// A cube whose sides look inward, all or all but the first `outward`, shrunk by `size` about its middle.
Model inward_cube(int outward, double size = 1) {
    Patchwork p;
    const int quads[6][4] = {{0, 2, 1, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                             {2, 6, 3, 7}, {0, 4, 2, 6}, {1, 3, 5, 7}};
    const Vec<3> middle{{0.5, 0.5, 0.5}};
    for (int i = 0; i < 6; ++i) {
        std::array<Vec<3>, 4> c;
        for (int k = 0; k < 4; ++k) {
            const int turned = i < outward || k == 0 || k == 3 ? k : 3 - k;
            c[std::size_t(k)] = middle + size * (corner(quads[i][turned]) - middle);
        }
        p.add(c);
    }
    return p.model();
}

TEST(Sew, what_becomes_closed_looks_outward) {
    for (const int outward : {0, 1, 2, 5}) {
        const Model loose = inward_cube(outward);
        const auto s = sew(loose, {.tolerance = 1e-6});
        ASSERT_TRUE(s);
        expect_sound(*s, loose);
        EXPECT_EQ(int(s->flipped.size()), 6 - outward);
        const auto t = tessellate(s->model, {.tolerance = 0.01});
        EXPECT_EQ(t->topology.misoriented_edges, 0);
        EXPECT_NEAR(signed_volume(t->mesh), 1, 1e-12) << outward;
    }
}

TEST(Sew, what_may_be_a_hollow_keeps_its_side) {
    Model both = loose_cube(0);
    const Model hollow = inward_cube(0, 0.5);
    const int vertices = int(both.vertices.size()), edges = int(both.edges.size()),
              faces = int(both.faces.size());
    for (const Vertex& v : hollow.vertices) both.vertices.push_back(v);
    for (Edge e : hollow.edges) {
        e.start += vertices, e.end += vertices;
        both.edges.push_back(e);
    }
    for (Face f : hollow.faces) {
        for (Coedge& c : f.loops[0].coedges) c.edge += edges;
        both.shells[0].faces.push_back({int(both.faces.size()), false});
        both.faces.push_back(f);
    }
    const Model loose = *make_model(both);
    const auto s = sew(loose, {.tolerance = 1e-6});
    ASSERT_TRUE(s);
    EXPECT_TRUE(s->flipped.empty());
    EXPECT_NEAR(signed_volume(tessellate(s->model, {.tolerance = 0.01})->mesh), 1 - 0.125, 1e-12);
    // One of its sides is wrong now, so nothing is known of what it was.
    Model mixed = loose;
    mixed.faces[std::size_t(faces)].reversed = true;
    EXPECT_NEAR(signed_volume(tessellate(sew(mixed, {.tolerance = 1e-6})->model, {.tolerance = 0.01})->mesh),
                1 + 0.125, 1e-12);
}

TEST(Sew, what_is_farther_apart_than_the_tolerance_stays_and_is_named) {
    Patchwork p;
    p.add({corner(0), corner(1), corner(2), corner(3)});
    const Vec<3> off{{1e-3, 0, 0}};
    p.add({corner(1) + off, corner(1) + Vec<3>{{1, 0, 0}}, corner(3) + off, corner(3) + Vec<3>{{1, 0, 0}}});
    const Model loose = p.model();
    const auto apart = sew(loose, {.tolerance = 0.9e-3});
    ASSERT_TRUE(apart);
    expect_sound(*apart, loose);
    EXPECT_TRUE(apart->joined.empty());
    ASSERT_EQ(apart->remaining.size(), 8u);
    double least = 1;
    for (const RemainingGap& g : apart->remaining) {
        least = std::min(least, g.gap);
        EXPECT_EQ(g.reason.kind, RefusalKind::no_answer);
        EXPECT_EQ(g.face_name, "face " + std::to_string(g.face));
    }
    EXPECT_NEAR(least, 1e-3, 1e-9);
    const auto joined = sew(loose, {.tolerance = 1.1e-3});
    ASSERT_EQ(joined->joined.size(), 1u);
    expect_sound(*joined, loose);
    EXPECT_GE(joined->joined[0].bound, 1e-3 * (1 - 1e-9));
    EXPECT_NEAR(tessellate(joined->model, {.tolerance = 0.01})->boundary_gap, 1e-3, 1e-9);
}

TEST(Sew, one_long_edge_against_two_short_ones_is_cut) {
    Patchwork p;
    p.noise = 1e-6;
    p.add({corner(0), corner(1), corner(2), corner(3)}, {{{}, {0.25, 0.7}, {}, {}}});
    for (const auto& [y0, y1] : {std::pair{0.0, 0.4}, std::pair{0.4, 1.0}})
        p.add({Vec<3>{{1, y0, 0}}, Vec<3>{{2, y0, 0}}, Vec<3>{{1, y1, 0}}, Vec<3>{{2, y1, 0}}});
    const Model loose = p.model();
    const auto s = sew(loose, {.tolerance = 1e-5});
    ASSERT_TRUE(s);
    expect_sound(*s, loose);
    EXPECT_EQ(s->joined.size(), 5u);  // 0, 0.25, 0.4, 0.7, 1 on the common line, and the line between the two
    EXPECT_EQ(s->split, 3);
    EXPECT_EQ(s->remaining.size(), 7u);
    const auto t = tessellate(s->model, {.tolerance = 0.01});
    EXPECT_EQ(t->topology.misoriented_edges + t->topology.non_manifold_edges, 0);
    EXPECT_EQ(t->topology.open_edges, 7);
}

TEST(Sew, corners_a_little_beside_each_other_make_no_loop) {
    // The second face reaches over the first, so each has a corner on a side of the other.
    for (const double over : {1e-8, 5e-6}) {
        Patchwork p;
        p.add({corner(0), corner(1), corner(2), corner(3)}, {{{}, {}, {}, {0.5}}});
        p.add({Vec<3>{{-1, 0, 0}}, Vec<3>{{over, 0, 0}}, Vec<3>{{-1, 1, 0}}, Vec<3>{{over, 1, 0}}});
        const Model loose = p.model();
        const auto s = sew(loose, {.tolerance = 1e-5});
        ASSERT_TRUE(s);
        expect_sound(*s, loose);
        EXPECT_EQ(s->joined.size(), 2u);
        EXPECT_EQ(s->split, 1);
        EXPECT_EQ(s->remaining.size(), 6u);
        for (const Edge& e : s->model.edges) EXPECT_NE(e.start, e.end);
        const auto t = tessellate(s->model, {.tolerance = 0.01});
        EXPECT_TRUE(t->refused.empty());
        EXPECT_EQ(t->topology.misoriented_edges + t->topology.non_manifold_edges, 0);
    }
}

TEST(Sew, a_short_edge_at_the_end_of_a_long_one_is_joined) {
    Patchwork p;
    p.add({corner(0), corner(1), corner(2), corner(3)}, {{{}, {0.005}, {}, {}}});
    p.add({corner(1), corner(1) + corner(1), corner(3), corner(3) + corner(1)});
    const Model loose = p.model();
    const auto s = sew(loose, {.tolerance = 0.02});
    ASSERT_TRUE(s);
    expect_sound(*s, loose);
    EXPECT_EQ(s->joined.size(), 2u);
    EXPECT_EQ(s->remaining.size(), 6u);
}

TEST(Sew, three_faces_on_one_edge_are_kept_and_named) {
    Patchwork p;
    p.add({corner(0), corner(1), corner(2), corner(3)});
    p.add({corner(0), corner(1), corner(4), corner(5)});
    p.add({corner(0), corner(1), Vec<3>{{0, -1, 0}}, Vec<3>{{1, -1, 0}}});
    const Model loose = p.model();
    const auto s = sew(loose, {.tolerance = 1e-6});
    ASSERT_TRUE(s);
    expect_sound(*s, loose);
    ASSERT_EQ(s->joined.size(), 1u);
    EXPECT_EQ(s->joined[0].faces, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(tessellate(s->model, {.tolerance = 0.1})->topology.non_manifold_edges, 1);
}

TEST(Sew, two_pairs_on_one_line_stay_two_pairs) {
    Patchwork p;
    const double thin = 1e-4;
    for (const double z : {0.0, thin}) {
        p.add({Vec<3>{{0, 0, z}}, Vec<3>{{1, 0, z}}, Vec<3>{{0, 1, z}}, Vec<3>{{1, 1, z}}});
        p.add({Vec<3>{{1, 0, z}}, Vec<3>{{2, 0, z}}, Vec<3>{{1, 1, z}}, Vec<3>{{2, 1, z}}});
    }
    const Model loose = p.model();
    const auto s = sew(loose, {.tolerance = thin / 2});
    expect_sound(*s, loose);
    EXPECT_EQ(s->joined.size(), 2u);
    const auto wide = sew(loose, {.tolerance = 2 * thin});
    expect_sound(*wide, loose);
    for (const SewnEdge& j : wide->joined) EXPECT_EQ(j.faces.size(), 2u);
}

TEST(Sew, edges_shorter_than_the_tolerance_do_not_collapse) {
    // The common side of one face has a short edge that the other has too, or has not.
    for (const bool both : {true, false}) {
        Patchwork p;
        p.add({corner(0), corner(1), corner(2), corner(3)}, {{{}, {0.5, 0.505}, {}, {}}});
        p.add({corner(1), corner(1) + corner(1), corner(3), corner(3) + corner(1)},
              {{{}, {}, {}, both ? std::vector{0.495, 0.5} : std::vector<double>{}}});
        const Model loose = p.model();
        const auto s = sew(loose, {.tolerance = 0.02});
        ASSERT_TRUE(s);
        expect_sound(*s, loose);
        EXPECT_EQ(s->joined.size(), 3u) << both;
        EXPECT_EQ(s->remaining.size(), 6u) << both;
        for (const Edge& e : s->model.edges) EXPECT_NE(e.start, e.end);
        EXPECT_EQ(s->vertex_moved < 1e-12, true);
    }
    // Faces that are small as a whole: nothing is nearer than they are large.
    Patchwork p;
    const double d = 1e-3;
    p.add({d * corner(0), d * corner(1), d * corner(2), d * corner(3)});
    p.add({d * corner(4), d * corner(5), d * corner(6), d * corner(7)});
    const Model loose = p.model();
    const auto s = sew(loose, {.tolerance = 0.1});
    expect_sound(*s, loose);
    EXPECT_TRUE(s->joined.empty());
    bool said = false;
    for (const RemainingGap& g : s->remaining) said = said || g.reason.kind == RefusalKind::ill_conditioned;
    EXPECT_TRUE(said);
}

TEST(Sew, holes_smaller_than_the_tolerance_stay_holes) {
    const double r = 1e-3;
    Model m;
    Face f;
    f.surface = Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};
    const Vec<2> corners[] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    Loop outer;
    for (int k = 0; k < 4; ++k) {
        const Vec<2> a = corners[k], d = corners[(k + 1) % 4] - a;
        m.vertices.push_back({{{a[0], a[1], 0}}, 0});
        m.edges.push_back(
            {Line<3>{{{a[0], a[1], 0}}, {{d[0], d[1], 0}}}, false, {0, 1}, k, (k + 1) % 4, 0, ""});
        outer.coedges.push_back({k, false, Line<2>{a, d}});
    }
    m.vertices.push_back({{{0.5 + r, 0.5, 0}}, 0});
    m.edges.push_back({Conic<3>{ConicKind::ellipse, {{0.5, 0.5, 0}}, {{r, 0, 0}}, {{0, -r, 0}}},
                       false,
                       {0, 2 * kPi},
                       4,
                       4,
                       0,
                       ""});
    const Loop hole{{{4, false, Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{r, 0}}, {{0, -r}}}}}};
    f.loops = {outer, hole};
    m.faces = {f};
    m.shells = {{{{0, false}}, false}};
    m.bodies = {{{0}, false, "", {}}};
    const Model loose = *make_model(std::move(m));
    const auto s = sew(loose, {.tolerance = 10 * r});
    ASSERT_TRUE(s);
    EXPECT_EQ(s->remaining.size(), 5u);
    EXPECT_TRUE(s->model.approximations.empty());
    EXPECT_EQ(summary(s->model).degenerate_edges, 0);
}

TEST(Sew, closed_edges_with_different_seams_and_speeds_meet) {
    for (const double turn : {0.0, 1.0, kPi}) {
        // A disc whose rim starts at `turn`, as a rational spline, under the wall of a cone.
        Model m = frustum(2, 1, 3);
        const int rim = 1;
        Model loose = m;
        const auto circle = [&](double r, double from) {
            std::vector<Hom<3>> c3;
            std::vector<Hom<2>> c2;
            for (int i = 0; i <= 8; ++i) {
                const double w = i % 2 ? std::sqrt(0.5) : 1, a = from + i * kPi / 4;
                const double x = r * std::cos(a) * (i % 2 ? 1 : w), y = r * std::sin(a) * (i % 2 ? 1 : w);
                c3.push_back({{x, y, 0, w}});
                c2.push_back({{x, y, w}});
            }
            const auto basis = *BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4});
            return std::pair{*Curve<Hom<3>>::make({basis}, Net<1, Hom<3>>({9}, c3)),
                             *Curve<Hom<2>>::make({basis}, Net<1, Hom<2>>({9}, c2))};
        };
        const auto [space, plane] = circle(2, turn);
        loose.vertices.push_back({jet<0>(CurveGeometry<3>(space), 0).value(), 0});
        const int v = int(loose.vertices.size()) - 1;
        loose.edges.push_back({CurveGeometry<3>(space), false, {0, 4}, v, v, 0, "rim"});
        for (Coedge& c : loose.faces[1].loops[0].coedges)
            if (c.edge == rim) c = {int(loose.edges.size()) - 1, false, CurveGeometry<2>(plane)};
        ASSERT_EQ(summary(loose).open_edges, 2);
        const auto s = sew(loose, {.tolerance = 1e-4});
        ASSERT_TRUE(s);
        expect_sound(*s, loose);
        EXPECT_TRUE(s->remaining.empty()) << turn;
        EXPECT_EQ(s->joined.size(), turn == 0 ? 1u : 2u);
        const auto t = tessellate(s->model, {.tolerance = 0.01});
        EXPECT_TRUE(t->refused.empty());
        EXPECT_EQ(t->topology.open_edges + t->topology.misoriented_edges + t->topology.non_manifold_edges, 0);
        EXPECT_LE(sampled_deviation(s->model, *t), t->error_bound + t->boundary_gap);
    }
}

TEST(Sew, a_strip_that_is_narrower_than_the_tolerance_does_not_close_on_itself) {
    Patchwork p;
    const double w = 1e-3;
    p.add({Vec<3>{{0, 0, 0}}, Vec<3>{{w, 0, 0}}, Vec<3>{{0, 1, 0}}, Vec<3>{{w, 1, 0}}});
    const Model loose = p.model();
    const auto s = sew(loose, {.tolerance = 2 * w});
    ASSERT_TRUE(s);
    expect_sound(*s, loose);
    EXPECT_TRUE(s->joined.empty());
    EXPECT_EQ(s->remaining.size(), 4u);
}

TEST(Sew, scales_exactly_with_powers_of_two) {
    const Model one = loose_cube(1e-3);
    const auto plain = sew(one, {.tolerance = 0.01});
    for (const int k : {-60, 60}) {
        Model big = one;
        const double f = std::ldexp(1.0, k);
        for (Vertex& v : big.vertices) v.point *= f;
        for (Edge& e : big.edges) {
            auto& line = std::get<Line<3>>(*e.curve);
            line.origin *= f, line.direction *= f;
        }
        for (Face& face : big.faces) {
            const auto& old = std::get<Surface<Vec<3>>>(face.surface);
            std::vector<Vec<3>> net;
            for (const Vec<3>& c : old.net().flat()) net.push_back(f * c);
            face.surface = *Surface<Vec<3>>::make(old.bases(), Net<2, Vec<3>>({2, 2}, net));
        }
        const auto s = sew(big, {.tolerance = f * 0.01});
        ASSERT_EQ(s->joined.size(), plain->joined.size()) << k;
        for (std::size_t i = 0; i < s->joined.size(); ++i) {
            EXPECT_EQ(s->joined[i].bound, f * plain->joined[i].bound);
            EXPECT_EQ(s->joined[i].edge, plain->joined[i].edge);
        }
        EXPECT_EQ(s->vertex_moved, f * plain->vertex_moved);
    }
}

TEST(Sew, refuses_tolerances_that_are_none_and_leaves_whole_models_alone) {
    const Model whole = torus(3, 1);
    EXPECT_EQ(sew(whole, {.tolerance = 0}).error().kind, RefusalKind::invalid);
    EXPECT_EQ(sew(whole, {.tolerance = -1}).error().where, "tolerance");
    EXPECT_EQ(sew(whole, {.tolerance = NAN}).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(sew(whole, {.tolerance = HUGE_VAL}).error().kind, RefusalKind::nonfinite);
    const auto s = sew(whole, {.tolerance = 1e3});
    EXPECT_TRUE(s->joined.empty() && s->remaining.empty());
    EXPECT_EQ(s->model.edges.size(), whole.edges.size());
    const Model empty;
    EXPECT_TRUE(sew(empty, {.tolerance = 1})->remaining.empty());
    EXPECT_EQ(largest_tolerance(whole), 0);
}

}  // namespace
