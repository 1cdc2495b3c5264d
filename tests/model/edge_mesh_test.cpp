// The passes that place the ends of chords, each by its law (edge_parts.cpp, edge_error.cpp).
#include "model/edge_mesh_detail.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <gtest/gtest.h>
#include <numeric>

using namespace freiform;
using namespace freiform::test;

namespace {

// A face in a plane or on `surface` between a curve of its parameters and the chord back; edge 0 is the
// curve.
struct OneFace {
    Model model;
    std::vector<std::unique_ptr<DerivativeQuery<2, 3>>> surfaces;
    std::vector<std::optional<Apex>> apexes;
    std::optional<EdgeMesher> mesher;

    OneFace(const CurveGeometry<2>& curve, Interval on,
            SurfaceGeometry surface = Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane}) {
        const Vec<2> a = jet<0>(curve, on.lo).value(), b = jet<0>(curve, on.hi).value();
        const auto at = [&](const Vec<2>& p) { return jet<0>(surface, p.c).value(); };
        model.vertices = {{at(a), 0}, {at(b), 0}};
        auto lift = lifted(surface, curve);
        std::optional<CurveGeometry<3>> own;
        if (lift && lift->on_plane) own = *lift->geometry;
        model.edges = {{own, false, on, 0, 1, 0, "curve"}, {{}, false, on, 1, 0, 0, "back"}};
        Face f;
        f.surface = std::move(surface);
        f.loops = {{{{0, false, curve}, {1, false, segment(on, b, a)}}}};
        model.faces = {f};
        surfaces.push_back(std::make_unique<DerivativeQuery<2, 3>>(model.faces[0].surface));
        apexes.push_back(apex_of(model.faces[0].surface));
        mesher.emplace(model, surfaces, apexes);
    }
    // What the chords of the curve ask for, once it is cut.
    std::vector<double> needs(double tolerance) {
        const EdgeDemands demands{tolerance};
        EXPECT_TRUE(mesher->discretise(0, demands, 100'000));
        const EdgeMesh& mesh = mesher->mesh(0);
        std::vector<double> out;
        double bound = 0;
        for (std::size_t i = 0; i + 1 < mesh.parameters.size(); ++i) {
            const auto p = mesher->part(0, mesh.parameters[i], mesh.parameters[i + 1], demands);
            EXPECT_LE(p.needs, 1) << "part " << i;
            out.push_back(p.needs);
            bound = std::max(bound, p.bound);
        }
        EXPECT_EQ(mesh.bound, bound) << "of every chord, and of no part that another stood for";
        return out;
    }
};

double sum_of(const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0); }

CurveGeometry<2> ellipse(double a, double b) { return Conic<2>{ConicKind::ellipse, {}, {{a, 0}}, {{0, b}}}; }
// Half of a circle as one rational cubic: slow in the middle.
CurveGeometry<2> uneven_half_circle() {
    return Curve<Hom<2>>::trusted(
        {*BSplineBasis::bezier(3)},
        Net<1, Hom<2>>(
            {4}, {{{1, 0, 1}}, {{1.0 / 3, 2.0 / 3, 1.0 / 3}}, {{-1.0 / 3, 2.0 / 3, 1.0 / 3}}, {{-1, 0, 1}}}));
}
CurveGeometry<2> wave(Random& rng, int size) {
    std::vector<Vec<2>> p;
    for (int i = 0; i < size; ++i) p.push_back({{double(i), rng.real(-1, 1)}});
    return Curve<Vec<2>>::trusted({*BSplineBasis::clamped_uniform(3, size)}, Net<1, Vec<2>>({size}, p));
}

// A curve with a corner, whose edge has it where rounding put it: a few units of the last place beside, or at
// the end of the edge, or in another place altogether.
TEST(EdgeMesh, kinks_that_are_one_but_for_rounding_get_one_vertex) {
    const auto corner = [](double at) {
        return *Curve<Vec<2>>::make({*BSplineBasis::make(1, {-1, -1, at, 1, 1})},
                                    Net<1, Vec<2>>({3}, {{{-1, 0}}, {{at, 1 - at}}, {{1, 0}}}));
    };
    for (const double beside : {0.0, 4e-16, -4e-16, 1e-13, 1e-6, 0.25})
        for (const double at : {0.3, 1 - 5e-14}) {
            if (at + beside >= 1) continue;
            OneFace face(corner(at), {-1, 1});
            std::vector<Vec<3>> c;
            const auto own = corner(at + beside);
            for (const Vec<2>& p : points(own)) c.push_back({{p[0], p[1], 0}});
            face.model.edges[0].curve = *Curve<Vec<3>>::make(own.bases(), Net<1, Vec<3>>({3}, c));
            face.mesher.emplace(face.model, face.surfaces, face.apexes);
            ASSERT_TRUE(face.mesher->discretise(0, {1e-3}, 1000));
            const auto& t = face.mesher->mesh(0).parameters;
            for (std::size_t i = 0; i + 1 < t.size(); ++i)
                EXPECT_GT(t[i + 1] - t[i], 1e-12) << beside << " " << at;
            EXPECT_EQ(t.front(), -1);
            EXPECT_EQ(t.back(), 1);
            EXPECT_EQ(t.size(), at > 0.5 ? 2u : beside > 1e-9 ? 4u : 3u) << beside << " " << at;
        }
}

TEST(EdgeMesh, the_error_is_shared_evenly) {
    for (const auto& [curve, on] :
         {std::pair{ellipse(4, 1), Interval{0.1, 3}}, std::pair{ellipse(1, 20), Interval{0, 6}},
          std::pair{uneven_half_circle(), Interval{0, 1}}})
        for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
            const auto needs = OneFace(curve, on).needs(tolerance);
            const auto [least, most] = std::minmax_element(needs.begin(), needs.end());
            EXPECT_GE(*least, 0.65 * *most) << tolerance;
            EXPECT_LE(double(needs.size()), sum_of(needs) / 0.88) << tolerance;
        }
}

// Of a closed curve that repeats itself the first part, and the one half a turn from it, are not all parts.
TEST(EdgeMesh, what_two_parts_ask_for_is_not_what_all_do) {
    for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6}) {
        const auto needs = OneFace(ellipse(4, 1), {0, 2 * kPi}).needs(tolerance);
        EXPECT_LE(double(needs.size()), sum_of(needs) / 0.9) << tolerance;
    }
}

TEST(EdgeMesh, hardly_more_chords_are_made_than_the_shares_ask_for) {
    Random rng(4);
    double asked = 0, made = 0;
    for (int round = 0; round < 12; ++round) {
        const int size = 12 + 4 * round;
        const auto curve = wave(rng, size);
        const auto needs = OneFace(curve, domain(curve)[0]).needs(0.01);
        asked += sum_of(needs), made += double(needs.size());
    }
    EXPECT_LE(made, asked / 0.9);
}

// Where samples of many parts stand for the others, an uneven curve is still cut by what each part asks for.
TEST(EdgeMesh, pilots_only_guess) {
    for (double tolerance = 1e-3; tolerance > 1e-6; tolerance *= 0.6)  // some guesses look as if they kept it
        EXPECT_GT(OneFace(ellipse(1, 1), {0, 3}).needs(tolerance).size(), 10u);
    const auto needs = OneFace(ellipse(30, 1), {0, 3}).needs(1e-6);
    ASSERT_GE(needs.size(), 1000u);
    const auto [least, most] = std::minmax_element(needs.begin(), needs.end());
    EXPECT_GE(*least, 0.9 * *most);
    EXPECT_LE(double(needs.size()), sum_of(needs) / 0.95);
}

// Half of a cylinder as a rational cubic: slow in the middle.
SurfaceGeometry uneven_wall() {
    std::vector<Hom<3>> c;
    const double x[] = {1, 1, -1, -1}, y[] = {0, 2, 2, 0}, w[] = {1, 1.0 / 3, 1.0 / 3, 1};
    for (int i = 0; i < 4; ++i)
        for (const double z : {0.0, 2.0}) c.push_back(weighted(Vec<3>{{x[i], y[i], z}}, w[i]));
    return *Surface<Hom<3>>::make({*BSplineBasis::bezier(3), *BSplineBasis::bezier(1)},
                                  Net<2, Hom<3>>({4, 2}, c));
}

// Spans so short that second derivatives are huge on them, as between a bend's two knots: each of the four
// costs some chords around it, not as many of the whole curve as that derivative would ask for everywhere.
TEST(EdgeMesh, what_short_spans_ask_for_is_not_asked_for_everywhere) {
    for (const double span : {0.3, 1e-3, 1e-5}) {
        std::vector<double> knots{0, 0, 0};
        std::vector<Vec<2>> p{{{0, 0}}};
        for (int i = 1; i <= 4; ++i) {
            knots.insert(knots.end(), {double(i), i + span});
            p.push_back({{i + 0.0, i % 2 * 0.4}});
            p.push_back({{i + span, i % 2 * 0.4 + span * (i % 2 ? -0.4 : 0.4)}});
        }
        p.insert(p.end(), {{{4.7, 0.1}}, {{5.5, 0}}});
        knots.insert(knots.end(), {6.0, 6.0, 6.0});
        const auto basis = BSplineBasis::make(2, knots);
        ASSERT_TRUE(basis) << span;
        const auto curve = [&](double scale) -> CurveGeometry<2> {
            std::vector<Vec<2>> q;
            for (const Vec<2>& x : p) q.push_back(scale * x);
            return Curve<Vec<2>>::trusted({*basis}, Net<1, Vec<2>>({int(q.size())}, q));
        };
        const auto needs = OneFace(curve(1), {0, 6}).needs(0.003);
        EXPECT_LE(needs.size(), 60u) << span;
        EXPECT_GE(needs.size(), 9u) << span;
        const auto on_wall = OneFace(curve(0.125), {0, 6}, uneven_wall()).needs(0.003);
        EXPECT_LE(on_wall.size(), 60u) << span;
        EXPECT_GE(on_wall.size(), 9u) << span;
        OneFace closed(curve(1), {0, 6});
        closed.model.edges[0].end = 0;
        EXPECT_GE(closed.needs(300).size(), 4u) << "a closed edge does not become a slit";
    }
}

// On a cylinder whose speed round its axis is uneven: a helix is cut as by its distance from chords.
TEST(EdgeMesh, chords_on_faces_are_judged_across) {
    const SurfaceGeometry wall = uneven_wall();
    const CurveGeometry<2> slanted = Line<2>{{{0, 0}}, {{1, 0.5}}};
    OneFace f(slanted, {0, 1}, wall);
    double worst = 0;
    for (double a = 0; a < 0.94; a += 0.05) {
        const double b = a + 0.05, bound = f.mesher->error(0, a, b, 0, false).polyline;
        const auto at = [&](double t) { return jet<0>(wall, {t, 0.5 * t}).value(); };
        const Vec<3> chord = at(b) - at(a);
        double most = 0;
        for (int i = 1; i < 64; ++i) {
            const Vec<3> d = at(a + (b - a) * i / 64) - at(a);
            most = std::max(most, norm(d - (dot(d, chord) / dot(chord, chord)) * chord));
        }
        EXPECT_LE(most, bound) << a;
        worst = std::max(worst, bound / most);
    }
    EXPECT_LE(worst, 1.8);
}

// Over all of it nothing is known of the normal, and so nothing of the offset.
TEST(EdgeMesh, no_bound_is_not_the_bound_zero) {
    const auto base = std::make_shared<const SurfaceGeometry>(rolling(5, 0.2));
    for (int axis = 0; axis < 2; ++axis) {
        Line<2> side;
        side.origin[1 - axis] = 1;
        side.direction[axis] = 1;
        const OneFace f(side, {0, 1}, OffsetSurface{base, 0.3});
        ASSERT_EQ((*f.surfaces[0])({Interval{1, 1}, Interval{0, 1}})(0, 2), kInfinity);
        const SegmentError whole = f.mesher->error(0, 0, 1, 0.05, false);
        EXPECT_EQ(whole.polyline, kInfinity);
        EXPECT_EQ(whole.triangle, kInfinity);
        const SegmentError part = f.mesher->error(0, 0.5, 0.55, 0.05, false);
        EXPECT_LT(part.polyline, 0.05);
        EXPECT_GT(part.polyline, 0);
    }
}

// Of a cone: between a straight side and the one that triangles stand for is something, unless both are one.
TEST(EdgeMesh, slivers_of_cones_are_as_wide_as_sides_bow) {
    const Revolution cone{Line<3>{{{2, 0, 0}}, {{-1, 0, 1}}}, {}, {{0, 0, 1}}, SurfaceKind::cone};
    const auto sliver = [&](Vec<2> from, Vec<2> to) {
        const Line<2> side{from, to - from};
        const OneFace f(side, {0, 1}, cone);
        return f.mesher->error(0, 0, 1, 1, false);
    };
    EXPECT_EQ(sliver({{0, 0}}, {{0.3, 0}}).sliver, 0);
    EXPECT_EQ(sliver({{0, 0}}, {{0, 1.5}}).sliver, 0);
    const SegmentError slanting = sliver({{0, 0}}, {{0.3, 1.5}});
    // Heights of 1 and 1/4: a third of the width; radius 2.
    EXPECT_GE(slanting.sliver, 2 * 0.1 * 0.1 / 8);
    EXPECT_LE(slanting.sliver, 1.2 * 2 * 0.1 * 0.1 / 8);
    EXPECT_GE(slanting.polyline, 0.3 * 0.3 / 2 * 2 / 9);
    EXPECT_LE(slanting.triangle, 0.3 * 0.3 / 2 * 2 / 9 * 1.001);
}

TEST(EdgeMesh, edges_are_cut_where_they_have_kinks_but_not_for_rounding) {
    const auto bent = [](double by) -> CurveGeometry<2> {
        return Curve<Vec<2>>::trusted(
            {*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2})},
            Net<1, Vec<2>>({5}, {{{0, 0}}, {{1, 1}}, {{2, 1.5 + by}}, {{3, 2}}, {{4, 0}}}));
    };
    for (const auto& [by, ends] : {std::pair{0.1, 3u}, std::pair{1e-13, 2u}}) {
        OneFace f(bent(by), {0, 2});
        EXPECT_EQ(f.mesher->smooth_pieces(0, 1e-3).size(), ends) << by;
        f.needs(1e-3);
        const auto& at = f.mesher->mesh(0).parameters;
        EXPECT_EQ(std::count(at.begin(), at.end(), 1.0), by > 0.01 ? 1 : 0) << by;
    }
}

}  // namespace
