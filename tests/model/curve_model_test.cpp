#include <freiform/core/constants.hpp>
#include <freiform/model/assemble.hpp>
#include <freiform/model/curve_model.hpp>
#include <freiform/model/rescale.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/shapes.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

ModelContacts met_by(const IntersectModel& model, const StraightLine& line) {
    ModelContacts out;
    EXPECT_TRUE(model.intersect(std::span(&line, 1), std::span(&out, 1)));
    EXPECT_TRUE(out.open.empty());
    return out;
}

// Every contact is where its parameters say, on the line and on the face.
void expect_places(const Model& model, const StraightLine& line, const ModelContacts& found, double slack) {
    for (const ModelContact& c : found.contacts) {
        const auto& at = c.contact.at;
        const Vec<3> x = line.point + at[0] * line.direction;
        EXPECT_LE(norm(x - c.contact.point), slack);
        const auto on_face = [&](int face, double u, double v) {
            return jet<0>(model.faces[std::size_t(face)].surface, std::array{u, v}).value();
        };
        EXPECT_LE(norm(on_face(c.face, at[1], at[2]) - x), c.contact.gap + slack);
        for (const ContactFace& o : c.others) EXPECT_LE(norm(on_face(o.face, o.uv[0], o.uv[1]) - x), 1e-9);
    }
}

TEST(CurveModel, lines_meet_a_sphere_where_the_quadratic_says_over_its_seam_too) {
    const Vec<3> centre{{0.5, -0.25, 1}};
    const Model ball = sphere(centre, 1.5);
    const IntersectModel query(ball);
    EXPECT_LT(query.search_bound(), 1e-13);
    std::mt19937 rng(1);
    int hits = 0;
    for (int n = 0; n < 300; ++n) {
        StraightLine line;
        for (int k = 0; k < 3; ++k)
            line.point[k] = uniform(rng, -2, 2), line.direction[k] = uniform(rng, -1, 1);
        if (n % 10 == 0) line.direction[1] = 0, line.point[1] = centre[1];  // through the seam, at v = 0
        if (n % 3 == 0) line.on.lo = 0;
        const Vec<3> from = line.point - centre;
        const double a = dot(line.direction, line.direction), b = dot(from, line.direction),
                     d = b * b - a * (dot(from, from) - 2.25);
        std::vector<double> wanted;
        if (d > 0)
            for (const double t : {(-b - std::sqrt(d)) / a, (-b + std::sqrt(d)) / a})
                if (line.on.contains(t)) wanted.push_back(t);
        const auto found = met_by(query, line);
        ASSERT_EQ(found.contacts.size(), wanted.size()) << n;
        for (std::size_t i = 0; i < wanted.size(); ++i)
            EXPECT_NEAR(found.contacts[i].contact.at[0], wanted[i], 1e-11);
        expect_places(ball, line, found, 1e-13);
        hits += int(wanted.size());
    }
    EXPECT_GT(hits, 200);
}

TEST(CurveModel, contacts_name_the_face_the_edge_and_the_neighbour) {
    const Model tube = frustum(1, 1, 2);  // z in [0, 2]
    const IntersectModel query(tube);
    const auto inside = met_by(query, {{{-3, 0.3, 1}}, {{1, 0, 0}}});
    ASSERT_EQ(inside.contacts.size(), 2u);
    for (const ModelContact& c : inside.contacts) {
        EXPECT_EQ(c.contact.kind, ContactKind::crossing);
        EXPECT_TRUE(c.contact.is_proven());
        EXPECT_EQ(c.edge, -1);
        EXPECT_EQ(c.face, inside.contacts[0].face);
    }
    // Through a disc, and on through the wall; along the axis through both discs.
    const auto across = met_by(query, {{{0, 0, 3}}, {{1, 0.25, -2}}, {0, kInfinity}});
    ASSERT_EQ(across.contacts.size(), 2u);
    EXPECT_NE(across.contacts[0].face, across.contacts[1].face);
    EXPECT_EQ(met_by(query, {{{0.1, 0.2, 0.5}}, {{0, 0, 1}}}).contacts.size(), 2u);
    EXPECT_EQ(met_by(query, {{{0.1, 0.2, 0.5}}, {{0, 0, 1}}, {0, kInfinity}}).contacts.size(), 1u);
    // Exactly through the rim, where the wall and a disc meet.
    int on_edge = 0;
    for (const ModelContact& c : met_by(query, {{{0.6 - 1, 0.8, 1}}, {{1, 0, 1}}, {0.5, 5}}).contacts) {
        EXPECT_EQ(c.contact.kind, ContactKind::end);
        EXPECT_EQ(c.contact.least, 0);
        EXPECT_GE(c.edge, 0);
        ASSERT_FALSE(c.others.empty());
        EXPECT_NE(c.others[0].face, c.face);
        ++on_edge;
    }
    EXPECT_EQ(on_edge, 1);
}

// A curve is met as often as a function of its parameter changes sign; tangent lines are told.
TEST(CurveModel, curves_cross_a_torus_as_often_as_its_equation_changes_sign) {
    const Model ring = torus(3, 1);
    const IntersectModel query(ring);
    std::mt19937 rng(7);
    int hits = 0;
    for (int n = 0; n < 20; ++n) {
        const auto basis = must(BSplineBasis::clamped_uniform(3, 8));
        std::vector<Hom<3>> net;
        for (int i = 0; i < 8; ++i)
            net.push_back(Space<Hom<3>>::lift(
                {{uniform(rng, -4, 4), uniform(rng, -4, 4), uniform(rng, -1.5, 1.5)}}, uniform(rng, 0.5, 2)));
        const auto curve = must(Curve<Hom<3>>::make({basis}, Net<1, Hom<3>>({8}, net)));
        const auto side = [&](double t) {
            const Vec<3> x = curve(t);
            const double out = std::hypot(x[0], x[1]) - 3;
            return out * out + x[2] * x[2] - 1;
        };
        int changes = 0;
        const Interval on = curve.domain()[0];
        double last = side(on.lo);
        for (int i = 1; i <= 20000; ++i) {
            const double now = side(clamped(on.lo + on.length() * i / 20000, on));
            changes += (now > 0) != (last > 0);
            last = now;
        }
        const auto found = must(query.intersect(curve));
        EXPECT_TRUE(found.open.empty());
        EXPECT_EQ(int(found.contacts.size()), changes) << n;
        for (const ModelContact& c : found.contacts) EXPECT_NEAR(side(c.contact.at[0]), 0, 1e-10);
        hits += changes;
    }
    EXPECT_GT(hits, 30);
    const auto touch = met_by(query, {{{4, -4, -1}}, {{0, 1, 0.25}}});  // at (4, 0, 0)
    ASSERT_EQ(touch.contacts.size(), 1u);
    EXPECT_NE(touch.contacts[0].contact.kind, ContactKind::crossing);
    EXPECT_TRUE(touch.contacts[0].contact.box[0].contains(4));
}

TEST(CurveModel, what_is_outside_of_the_loops_is_not_met_and_scale_changes_nothing) {
    Model m = sphere({}, 1);
    const double top = 0.4;  // the latitude of the rim
    for (Coedge& c : m.faces[0].loops[0].coedges) {
        const auto cut = [&](Vec<2> p) { return Vec<2>{{p[0], std::min(p[1], top)}}; };
        const Interval on = m.edges[std::size_t(c.edge)].range;
        c.curve = segment(on, cut(jet<0>(c.curve, on.lo).value()), cut(jet<0>(c.curve, on.hi).value()));
    }
    double at = 0;
    for (const int exponent : {0, 200, -200}) {
        const double unit = std::scalbn(1.0, exponent);
        const IntersectModel query(must(rescaled(m, exponent)));
        const StraightLine below{{{0, 0.1 * unit, 0.25 * unit}}, {{1, 0, 0}}},
            above{{{0, 0.1 * unit, 0.5 * unit}}, {{1, 0, 0}}},
            down{{{0.1 * unit, 0.1 * unit, 0}}, {{0, 0, 1}}};
        const auto two = met_by(query, below);
        ASSERT_EQ(two.contacts.size(), 2u);
        if (exponent == 0) at = two.contacts[1].contact.at[0];
        EXPECT_EQ(two.contacts[1].contact.at[0], at * unit);
        EXPECT_NEAR(two.contacts[1].contact.at[0] / unit, std::sqrt(1 - 0.01 - 0.0625), 1e-14);
        EXPECT_TRUE(met_by(query, above).contacts.empty());
        // Where the surface is searched, but the face has ended.
        EXPECT_TRUE(met_by(query, {{{0, 0.1 * unit, 0.45 * unit}}, {{1, 0, 0}}}).contacts.empty());
        EXPECT_EQ(met_by(query, down).contacts.size(), 1u);
    }
}

TEST(CurveModel, a_line_in_a_plane_face_overlaps_it_as_far_as_its_loops_reach) {
    const Model tube = frustum(1, 1, 2);  // z in [0, 2]
    const IntersectModel query(tube);
    for (const double slope : {0.0, 0.1, -0.5}) {
        const StraightLine line{{{-3, 0.25, 2}}, {{1, slope, 0}}};
        // |(-3 + t, 0.25 + slope t)| = 1
        const double a = 1 + slope * slope, b = -3 + 0.25 * slope, d = b * b - a * (8 + 0.0625);
        if (d < 0) continue;
        const auto found = met_by(query, line);
        ASSERT_EQ(found.overlaps.size(), 1u) << slope;
        const ModelOverlap& o = found.overlaps[0];
        EXPECT_NEAR(o.on.lo, (-b - std::sqrt(d)) / a, 1e-9);
        EXPECT_NEAR(o.on.hi, (-b + std::sqrt(d)) / a, 1e-9);
        EXPECT_LE(o.gap, 1e-13);
        ASSERT_EQ(found.contacts.size(), 2u);  // the rim, of the wall
        for (const ModelContact& c : found.contacts) {
            EXPECT_EQ(c.contact.kind, ContactKind::end);
            EXPECT_NE(c.face, o.face);
            EXPECT_LT(c.contact.box[0].length(), 1e-6);
        }
    }
    // Beside the disc, and a little above it.
    const auto beside = met_by(query, {{{-3, 1.5, 2}}, {{1, 0, 0}}}),
               above = met_by(query, {{{-3, 0, 2.001}}, {{1, 0, 0}}});
    EXPECT_TRUE(beside.overlaps.empty() && beside.contacts.empty());
    EXPECT_TRUE(above.overlaps.empty() && above.contacts.empty());
    // A parabola in the plane of the lower disc, from its middle out.
    const auto arc =
        must(Curve<Hom<3>>::make({must(BSplineBasis::bezier(2))},
                                 Net<1, Hom<3>>({3}, {weighted(Vec<3>{}, 1), weighted(Vec<3>{{1, 0, 0}}, 1),
                                                      weighted(Vec<3>{{2, 2, 0}}, 1)})));
    const auto along = must(query.intersect(arc));
    EXPECT_TRUE(along.open.empty());
    ASSERT_EQ(along.overlaps.size(), 1u);
    EXPECT_EQ(along.overlaps[0].on.lo, 0);
    const Vec<3> out = arc(along.overlaps[0].on.hi);
    EXPECT_NEAR(std::hypot(out[0], out[1]), 1, 1e-9);
}

// Sides of extruded outlines, and flat patches: splines that are planes, evenly.
TEST(CurveModel, lines_in_flat_splines_are_overlaps_too) {
    const auto basis = must(BSplineBasis::make(3, {0, 0, 0, 0, 0.25, 1, 1, 1, 1}));
    const std::array at{0.0, 0.25 / 3, 1.25 / 3, 2.25 / 3, 1.0};  // means of three knots
    const Vec<3> o{{1, 2, 3}}, u{{4, 0, 1}}, v{{0, 2, -1}};
    std::vector<Vec<3>> points, row;
    for (const double a : at) {
        row.push_back(o + a * u);
        for (const double b : at) points.push_back(o + a * u + b * v);
    }
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({5, 5}, points)))));
    Model flat = must(std::move(builder).finish());
    const Extrusion side{must(Curve<Vec<3>>::make({basis}, Net<1, Vec<3>>({5}, row))), v};
    for (const bool extruded : {false, true}) {
        if (extruded) flat.faces[0].surface = side;
        const IntersectModel query(flat);
        // At (a, b) = (-0.5 + t, 0.1 + 0.3 t): in the face from t = 0.5 to 1.5.
        const StraightLine line{o - 0.5 * u + 0.1 * v, u + 0.3 * v};
        const auto found = met_by(query, line);
        ASSERT_EQ(found.overlaps.size(), 1u) << extruded;
        EXPECT_NEAR(found.overlaps[0].on.lo, 0.5, 1e-9);
        EXPECT_NEAR(found.overlaps[0].on.hi, 1.5, 1e-9);
        EXPECT_LE(found.overlaps[0].gap, 1e-12);
        EXPECT_TRUE(met_by(query, {line.point + 0.01 * cross(u, v), line.direction}).overlaps.empty());
        EXPECT_TRUE(met_by(query, {line.point + 2 * v, line.direction}).overlaps.empty());
    }
    // Flat, but not evenly: what is not known is said.
    points[7] = points[7] + 0.1 * u;
    ModelBuilder other;
    ASSERT_TRUE(other.add(must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({5, 5}, points)))));
    const StraightLine line{o - 0.5 * u + 0.1 * v, u + 0.3 * v};
    ModelContacts out;
    ASSERT_TRUE(IntersectModel(must(std::move(other).finish()))
                    .intersect(std::span(&line, 1), std::span(&out, 1), {.max_parts = 2000}));
    EXPECT_TRUE(out.overlaps.empty());
    EXPECT_FALSE(out.open.empty());
}

// Where it is not decided whether it lies in the face, that is said: a line in the wall of the tube.
TEST(CurveModel, a_line_in_a_curved_face_is_open_there) {
    const Model tube = frustum(1, 1, 2);
    const StraightLine line{{{0.6, 0.8, -1}}, {{0, 0, 1}}};
    ModelContacts out;
    ASSERT_TRUE(IntersectModel(tube).intersect(std::span(&line, 1), std::span(&out, 1), {.max_parts = 2000}));
    EXPECT_TRUE(out.overlaps.empty());
    ASSERT_EQ(out.open.size(), 1u);
    ASSERT_FALSE(out.open[0].boxes.empty());
    for (double t = 1.05; t < 3; t += 0.1)
        EXPECT_TRUE(std::ranges::any_of(out.open[0].boxes, [&](const auto& box) {
            return box[0].contains(t);
        })) << t;
}

TEST(CurveModel, refuses_lines_that_are_none_and_leaves_offsets_open) {
    Model ball = sphere({}, 1);
    ModelContacts out;
    const StraightLine none{{}, {}}, any{{}, {{1, 0, 0}}};
    expect_refusal(IntersectModel(ball).intersect(std::span(&none, 1), std::span(&out, 1)),
                   RefusalKind::invalid, "lines[0]");
    expect_refusal(IntersectModel(ball).intersect(std::span(&any, 1), std::span(&out, 1), {.accuracy = -1}),
                   RefusalKind::invalid, "accuracy");
    ball.faces[0].surface = OffsetSurface{std::make_shared<SurfaceGeometry>(ball.faces[0].surface), 0.5};
    ASSERT_TRUE(IntersectModel(ball).intersect(std::span(&any, 1), std::span(&out, 1)));
    ASSERT_EQ(out.open.size(), 1u);
    EXPECT_EQ(out.open[0].reason->kind, RefusalKind::unsupported);
}

TEST(CurveModel, refusals_name_the_line_and_what_is_wrong_with_it) {
    const IntersectModel query(sphere({}, 1));
    const double nan = std::nan("");
    const StraightLine good{{}, {{1, 0, 0}}};
    const auto refusal = [&](const StraightLine& bad, double accuracy = 0) -> Result<void> {
        const std::array lines{good, bad};
        std::array<ModelContacts, 2> out;
        return query.intersect(lines, out, {.accuracy = accuracy});
    };
    EXPECT_TRUE(refusal(good));
    expect_refusal(refusal({{}, {}}), RefusalKind::invalid, "lines[1]", "no direction");
    expect_refusal(refusal({{{nan, 0, 0}}, {{1, 0, 0}}}), RefusalKind::nonfinite, "lines[1]");
    expect_refusal(refusal({{}, {{1, kInfinity, 0}}}), RefusalKind::nonfinite, "lines[1]");
    expect_refusal(refusal({{}, {{1, 0, 0}}, {1, 1}}), RefusalKind::invalid, "lines[1]", "[1, 1]");
    expect_refusal(refusal({{}, {{1, 0, 0}}, {2, nan}}), RefusalKind::invalid, "lines[1]");
    expect_refusal(refusal(good, nan), RefusalKind::invalid, "accuracy");
    const auto curve = must(Curve<Hom<3>>::make(
        {must(BSplineBasis::bezier(1))},
        Net<1, Hom<3>>({2}, {weighted(Vec<3>{{-2, 0, 0}}, 1), weighted(Vec<3>{{2, 0, 0}}, 1)})));
    const auto beside = must(Curve<Hom<3>>::make(
        {must(BSplineBasis::bezier(1))},
        Net<1, Hom<3>>({2}, {weighted(Vec<3>{{5, 5, 5}}, 1), weighted(Vec<3>{{9, 5, 5}}, 1)})));
    for (const double accuracy : {-1.0, nan})
        for (const auto& c : {curve, beside})
            expect_refusal(query.intersect(c, {.accuracy = accuracy}), RefusalKind::invalid, "accuracy");
    EXPECT_TRUE(must(query.intersect(beside)).contacts.empty());
    EXPECT_EQ(must(query.intersect(curve)).contacts.size(), 2u);
}

// One face of three cannot be met: the others are, and it is named.
TEST(CurveModel, faces_that_cannot_be_met_are_open_and_the_others_are_met) {
    Model tube = frustum(1, 1, 2);
    const StraightLine down{{{0.25, 0.25, 5}}, {{0, 0, -1}}};
    ASSERT_EQ(met_by(IntersectModel(tube), down).contacts.size(), 2u);
    int wall = -1;
    for (std::size_t f = 0; f < tube.faces.size(); ++f) {
        const auto* e = std::get_if<Extrusion>(&tube.faces[f].surface);
        if (!e || e->kind != SurfaceKind::plane) wall = int(f);
    }
    ASSERT_GE(wall, 0);
    auto& surface = tube.faces[std::size_t(wall)].surface;
    surface = OffsetSurface{std::make_shared<SurfaceGeometry>(surface), 0.5};
    ModelContacts out;
    ASSERT_TRUE(IntersectModel(tube).intersect(std::span(&down, 1), std::span(&out, 1)));
    EXPECT_EQ(out.contacts.size(), 2u);
    ASSERT_EQ(out.open.size(), 1u);
    EXPECT_EQ(out.open[0].face, wall);
    EXPECT_TRUE(out.open[0].boxes.empty());
    ASSERT_TRUE(out.open[0].reason);
    EXPECT_EQ(out.open[0].reason->kind, RefusalKind::unsupported);
}

}  // namespace
}  // namespace freiform::test
