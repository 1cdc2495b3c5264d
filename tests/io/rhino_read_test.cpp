// 3DM files: those that openNURBS wrote (tests/data/3dm), and bytes put together by hand.
#include <freiform/core/constants.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/rhino_read.hpp>
#include <freiform/model/deviation.hpp>
#include <freiform/model/tessellate.hpp>

#include <io/rhino_step.hpp>
#include <numbers>
#include <optional>
#include <support/corpus.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/rhino_bytes.hpp>
#include <support/solids.hpp>

namespace freiform::test::rhino {
namespace {

constexpr double kPi = std::numbers::pi;

std::string bytes_of(std::string_view name) {
    auto bytes = read_file(text(FREIFORM_SOURCE_DIR, "/tests/data/3dm/", name, ".3dm"), 1 << 20);
    EXPECT_TRUE(bytes) << name;
    return bytes ? std::move(*bytes) : std::string();
}
Model model_of(std::string_view name) { return must(read_3dm(bytes_of(name))); }

// Of a closed model.
double volume_of(const Model& m, double tolerance = 1e-3) {
    const auto t = must(tessellate(m, {.tolerance = tolerance}));
    EXPECT_EQ(t.topology.open_edges, 0);
    EXPECT_EQ(t.topology.misoriented_edges, 0);
    EXPECT_TRUE(t.refused.empty());
    return signed_volume(t.mesh);
}

double area_of(const TriangleMesh& mesh) {
    double area = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto p = mesh.points_of(i);
        const auto at = [&](std::size_t k) { return mesh.points[std::size_t(p[k])]; };
        area += norm(cross(at(1) - at(0), at(2) - at(0))) / 2;
    }
    return area;
}
double area_of(const Model& m, double tolerance = 1e-3) {
    const auto t = must(tessellate(m, {.tolerance = tolerance}));
    EXPECT_TRUE(t.refused.empty());
    return area_of(t.mesh);
}

// Every point of one is on the other, within three times the tolerance of meshes.
void expect_same(const Model& a, const Model& b, double tolerance) {
    for (const auto& [from, to] : {std::pair{&a, &b}, {&b, &a}}) {
        const auto t = must(tessellate(*from, {.tolerance = tolerance}));
        const auto d = must(deviation(*to, t.mesh, {.enough = 3 * tolerance}));
        EXPECT_LE(d.bound, 3 * tolerance);
        EXPECT_LE(d.mesh_measured, 3 * tolerance);
        EXPECT_TRUE(d.refused.empty());
    }
}

TEST(Rhino, solids_of_openNURBS_have_their_volumes) {
    // The profile of the slanted ones, and where its centre of gravity is.
    const std::vector<Vec<2>> profile{{{0, 0}}, {{3, 0}}, {{3, 2}}, {{1, 2.5}}};
    double area = 0;
    Vec<2> centre{};
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const Vec<2>&p = profile[i], &q = profile[(i + 1) % profile.size()];
        const double twice = p[0] * q[1] - p[1] * q[0];
        area += twice / 2;
        centre = centre + (twice / 6) * (p + q);
    }
    centre = (1 / area) * centre;
    const double slanted = 9 * (area - kPi * 0.16), cut = area * (9 - (0.2 * centre[0] + 0.1 * centre[1]));
    const double expected = 4 * kPi / 3 * 64 + 4 * kPi * 5 + 6 + 3 * kPi * 5 + 4 * kPi * 5 + slanted + cut;
    for (const std::string_view name : {"solids_2", "solids_4", "solids_8"}) {
        const Model m = model_of(name);
        const ModelSummary s = summary(m);
        EXPECT_EQ(s.solids, 7) << name;
        EXPECT_EQ(s.faces, 30) << name;
        EXPECT_EQ(s.open_edges, 0) << name;
        EXPECT_EQ(m.unit, "cm") << name;
        EXPECT_TRUE(m.refused.empty()) << name;
        EXPECT_NEAR(volume_of(m), expected, 0.3) << name;  // a thousandth of the surface of all
        ASSERT_EQ(m.bodies.size(), 7u);
        EXPECT_EQ(m.bodies[0].name, "sphere");
        EXPECT_EQ(m.bodies[6].name, "slanted, cut");
        ASSERT_EQ(m.layers.size(), 2u) << name;
        for (const Body& b : m.bodies) {
            ASSERT_EQ(b.layers.size(), 1u);
            EXPECT_EQ(m.layers[std::size_t(b.layers[0])].name, b.name == "box" ? "Körper" : "Default");
            EXPECT_EQ(b.colour.has_value(), b.name == "box") << name;
            if (b.colour) EXPECT_EQ(*b.colour, (Colour{1, 0.4, 0, 1})) << name;
        }
    }
}

// openNURBS itself makes polysurfaces of extrusions for old versions, and splines of arcs for the oldest.
TEST(Rhino, all_versions_say_the_same) {
    const Model now = model_of("solids_8");
    expect_same(now, model_of("solids_4"), 0.05);
    expect_same(now, model_of("solids_2"), 0.05);
    expect_same(model_of("sheets_8"), model_of("sheets_4"), 0.05);
}

TEST(Rhino, surfaces_by_themselves_are_faces_and_the_rest_is_told) {
    const Model m = model_of("sheets_8");
    EXPECT_EQ(m.faces.size(), 6u);
    EXPECT_EQ(summary(m).solids, 0);
    ASSERT_EQ(m.refused.size(), 2u);
    EXPECT_EQ(m.refused[0].message, "1 curve that bounds no face is left out");
    EXPECT_EQ(m.refused[1].message, "point: 1 object is left out");
    // Wall, parts of cones (slant height times mean circumference), rectangle, sphere; the bowl by an
    // integral.
    const double slope = std::sqrt(10.0), tall = std::sqrt(13.0);
    double bowl = 0;
    {  // the circle through (2, 0), (1.5, 2), (0, 2.5), turned about the second axis
        // Equal distances from the three points: 2 a (x1 - x2) + 2 b (y1 - y2) = |p1|^2 - |p2|^2.
        const double a11 = 2 * 0.5, a12 = 2 * -2.0, r1 = 4 - 6.25, a21 = 2 * 1.5, a22 = 2 * -0.5,
                     r2 = 6.25 - 6.25;
        const double det = a11 * a22 - a12 * a21, a = (r1 * a22 - a12 * r2) / det,
                     b = (a11 * r2 - r1 * a21) / det;
        const double radius = std::hypot(2 - a, b), from = std::atan2(-b, 2 - a),
                     to = std::atan2(2.5 - b, -a);
        constexpr int n = 100000;
        for (int i = 0; i < n; ++i) {
            const double t = from + (to - from) * (i + 0.5) / n;
            bowl += 2 * kPi * (a + radius * std::cos(t)) * radius * (to - from) / n;
        }
    }
    const double expected =
        4 * std::sqrt(10.0) + slope * 1.5 * 2 + tall * 1 * 2 * kPi + bowl + 6 + 4 * kPi * 16;
    EXPECT_NEAR(area_of(m), expected, 1e-3 * expected);
}

TEST(Rhino, curves_alone_are_wires) {
    for (const std::string_view name : {"curves_3", "curves_7"}) {
        const Model m = model_of(name);
        EXPECT_TRUE(m.faces.empty());
        EXPECT_TRUE(m.refused.empty());
        ASSERT_EQ(m.edges.size(), 8u) << name;  // line, circle, three of the polyline, two of the row, spline
        double length = 0;
        for (const Edge& e : m.edges) {
            Vec<3> last = jet<0>(*e.curve, e.range.lo).value();
            for (int i = 1; i <= 1000; ++i) {
                const Vec<3> p = jet<0>(*e.curve, e.range.lo + e.range.length() * i / 1000).value();
                length += norm(p - last);
                last = p;
            }
        }
        const auto& spline = m.edges.back();
        double own = 0;
        for (int i = 0; i < 1000; ++i)
            own +=
                norm(jet<0>(*spline.curve, spline.range.lo + spline.range.length() * (i + 1) / 1000).value() -
                     jet<0>(*spline.curve, spline.range.lo + spline.range.length() * i / 1000).value());
        const double expected = std::sqrt(27.0) + 4 * kPi + 1 + 1 + std::sqrt(21.0) + 1 + kPi / 2 + own;
        EXPECT_NEAR(length, expected, 1e-3) << name;
    }
}

TEST(Rhino, blocks_are_where_they_are_inserted_also_stretched) {
    for (const std::string_view name : {"blocks_4", "blocks_8"}) {
        const Model m = model_of(name);
        EXPECT_TRUE(m.refused.empty()) << name;
        ASSERT_EQ(m.bodies.size(), 5u) << name;
        for (const Body& b : m.bodies) EXPECT_EQ(b.name, "part");
        EXPECT_NEAR(volume_of(m), 6 + 6 + 48 + 12 + 12, 1e-9) << name;
        const Box<3> box = summary(m).box;
        const Vec<3> lo{{-4, 0, -20}}, hi{{21, 22, 33}};
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(box.lo[i], lo[i], 1e-9);
            EXPECT_NEAR(box.hi[i], hi[i], 1e-9);
        }
    }
}

Model read_hand_made(const std::vector<Written>& objects) { return must(read_3dm(file(objects))); }

// A cubic from (0, 0, 0) to (3, 0, 0).
Written bump() { return nurbs_curve(4, {0, 0, 0, 1, 1, 1}, {{0, 0, 0}, {1, 2, 0}, {2, -2, 0}, {3, 0, 0}}); }

TEST(Rhino, sums_of_curves_are_swept_or_splines) {
    const auto sum = [](const Written& a, const Written& b) {
        Written w;
        w.u8(0x10).f64s({0, 0, 5}).nothing(48).raw(a).raw(b);
        return object(kSum, w);
    };
    const Written up = line({{0, 0, 0}}, {{0, 0, 2}});
    const Written quarter = arc({{0, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, 2, 0, kPi / 2);
    // In both orders, and of two curves: in the middle of its parameters each is the sum of two middles.
    const Vec<3> middle{{1.5, 0, 5}};
    for (const auto& [a, b, offset] :
         {std::tuple{bump(), up, Vec<3>{{0, 0, 1}}},
          {up, bump(), Vec<3>{{0, 0, 1}}},
          {bump(), quarter, Vec<3>{{0, std::numbers::sqrt2, std::numbers::sqrt2}}}}) {
        const Model m = read_hand_made({sum(a, b)});
        ASSERT_EQ(m.faces.size(), 1u);
        EXPECT_TRUE(m.refused.empty());
        const auto t = must(tessellate(m, {.tolerance = 1e-4}));
        EXPECT_TRUE(t.refused.empty());
        double nearest = kInfinity;
        const Vec<3> wanted = middle + offset;
        for (std::size_t i = 0; i < t.mesh.triangles.size(); ++i) {
            const auto p = t.mesh.points_of(i);
            nearest = std::min(nearest, distance_to_triangle(wanted, t.mesh.points[std::size_t(p[0])],
                                                             t.mesh.points[std::size_t(p[1])],
                                                             t.mesh.points[std::size_t(p[2])]));
        }
        EXPECT_LE(nearest, 2e-4);
    }
}

// A cone with an open angle, with its parameters in both orders: normals are opposite.
TEST(Rhino, transposed_surfaces_of_revolution_have_the_other_normal) {
    const auto cone = [](bool transposed) {
        Written w;
        w.u8(0x20).f64s({0, 0, 0, 0, 0, 1, 0.5, 2.5, 0, 1}).nothing(48).i32(transposed).u8(1);
        w.raw(line({{2, 0, 0}}, {{1, 0, 3}}));
        return object(kRevolved, w);
    };
    for (const bool transposed : {false, true}) {
        const Model m = read_hand_made({cone(transposed)});
        ASSERT_EQ(m.faces.size(), 1u);
        const auto t = must(tessellate(m, {.tolerance = 1e-3}));
        EXPECT_NEAR(area_of(t.mesh), std::sqrt(10.0) * 1.5 * 2, 0.02);
        // u around the axis and v up: outward; seen from the axis all triangles turn one way.
        for (std::size_t i = 0; i < t.mesh.triangles.size(); ++i) {
            const auto p = t.mesh.points_of(i);
            const auto at = [&](std::size_t k) { return t.mesh.points[std::size_t(p[k])]; };
            const Vec<3> n = cross(at(1) - at(0), at(2) - at(0)), out{{at(0)[0], at(0)[1], 0}};
            EXPECT_EQ(dot(n, out) > 0, !transposed);
        }
    }
}

Written extrusion(const Written& profile, bool transposed, int capped, double from = 0, double to = 1,
                  int count = 1) {
    Written w, body;
    w.i32(1)
        .i32(2)
        .raw(profile)
        .f64s({0, 0, 0, 0, 0, 4, from, to, 0, 1, 0})
        .u8(0)
        .u8(0)
        .nothing(48)
        .f64s({0, 1});
    w.u8(transposed).i32(count).u8(capped & 1).u8(capped >> 1);
    return object(kExtrusion, body.chunk(0x40008000, w));
}
Written square(double side, bool backwards = false) {
    const double s = side / 2;
    std::vector<Vec<3>> p{{{-s, -s, 0}}, {{s, -s, 0}}, {{s, s, 0}}, {{-s, s, 0}}};
    if (backwards) std::swap(p[1], p[3]);
    std::vector<Written> sides;
    for (std::size_t i = 0; i < 4; ++i) sides.push_back(line(p[i], p[(i + 1) % 4]));
    return row(sides);
}

TEST(Rhino, extrusions_are_capped_as_they_say) {
    // Part of the path, in both senses of the profile and of the parameters: always outward.
    for (const bool backwards : {false, true})
        for (const bool transposed : {false, true}) {
            const Model m = read_hand_made({extrusion(square(2, backwards), transposed, 3, 0.25, 0.75)});
            EXPECT_EQ(summary(m).solids, 1);
            EXPECT_NEAR(volume_of(m), 4 * 2, 1e-12);
            EXPECT_NEAR(summary(m).box.lo[2], 1, 1e-12);
        }
    const auto holes = row({square(4), square(2)});
    EXPECT_NEAR(volume_of(read_hand_made({extrusion(holes, false, 3, 0, 1, 2)})), (16 - 4) * 4, 1e-12);
    for (const int capped : {0, 1, 2}) {
        const Model m = read_hand_made({extrusion(square(2), false, capped)});
        EXPECT_EQ(m.faces.size(), capped == 0 ? 4u : 5u);
        EXPECT_EQ(summary(m).open_edges, capped == 0 ? 8 : 4);
    }
    const Model open = read_hand_made({extrusion(bump(), false, 3)});
    EXPECT_EQ(open.faces.size(), 1u);
    EXPECT_EQ(summary(open).open_edges, 4);
}

TEST(Rhino, splines_end_where_their_domain_ends) {
    // A closed cubic with uniform knots: its ends are no control points.
    std::vector<std::vector<double>> points;
    for (int i = 0; i < 9; ++i) points.push_back({std::cos(i * kPi / 3), std::sin(i * kPi / 3), 0});
    std::vector<double> knots;
    for (int i = 0; i < 11; ++i) knots.push_back(i);
    const Model m = read_hand_made({nurbs_curve(4, knots, points)});
    ASSERT_EQ(m.edges.size(), 1u);
    const Edge& e = m.edges[0];
    EXPECT_EQ(e.start, e.end);
    EXPECT_EQ(e.range, (Interval{2, 8}));
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(
            jet<0>(*e.curve, 2).value()[i],
            (points[0][std::size_t(i)] + 4 * points[1][std::size_t(i)] + points[2][std::size_t(i)]) / 6,
            1e-15);
}

// A square in the plane z = 0 as a polysurface, whose last edge is part of a longer line, backwards.
// `surface`: another one than the plane, whose normal is down, so that the loop runs the other way.
enum class Damage { none, trim, loop_twice, no_edges };
Written square_brep(Damage damage = Damage::none, const std::optional<Written>& surface = {}) {
    const bool down = surface.has_value();
    const auto list = [](const Written& w) { return Written().chunk(0x40008000, w); };
    Written none, curves, surfaces, vertices, edges, trims, loops, faces, all;
    none.u8(0x10).i32(0);
    const std::array<Vec<3>, 4> p{{{{0, 0, 0}}, {{2, 0, 0}}, {{2, 2, 0}}, {{0, 2, 0}}}};
    curves.u8(0x10).i32(4);
    for (std::size_t i = 0; i < 4; ++i)
        curves.i32(1).raw(i < 3 ? line(p[i], p[i + 1]) : line({{0, -2, 0}}, {{0, 6, 0}}));
    surfaces.u8(0x10).i32(1).i32(1).raw(surface
                                            ? *surface
                                            : object(kPlane, Written()
                                                                 .u8(0x11)
                                                                 .f64s({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})
                                                                 .nothing(32)
                                                                 .f64s({0, 1, 0, 1, 0, 2, 0, 2})));
    vertices.u8(0x10).i32(4);
    for (int i = 0; i < 4; ++i)
        vertices.i32(i).f64s({p[std::size_t(i)][0], p[std::size_t(i)][1], 0}).i32(1).i32(0).f64(0);
    edges.u8(0x10).i32(4);
    for (int i = 0; i < 4; ++i) {
        const bool last = i == 3;
        edges.i32(i).i32(i).i32(last).f64s({last ? 0.25 : 0, last ? 0.5 : 1}).i32(i).i32((i + 1) % 4);
        edges.i32(1).i32(i).f64(0).f64s({0, 1});
    }
    trims.u8(0x10).i32(4);
    const bool singular = damage == Damage::no_edges;
    for (int i = 0; i < 4; ++i)
        trims.i32(i)
            .i32(-1)
            .f64s({0, 1})
            .i32(singular ? -1 : i)
            .i32(i)
            .i32((i + 1) % 4)
            .i32(down)
            .i32(singular ? 4 : 1)
            .i32(0)
            .i32(0)
            .f64s({0, 0})
            .nothing(48 + 16);
    loops.u8(0x10).i32(1).i32(0).i32(4);
    for (int i = 0; i < 4; ++i) loops.i32(damage == Damage::trim && i == 2 ? 9 : down ? 3 - i : i);
    loops.i32(1).i32(0);
    faces.u8(0x10).i32(1).i32(0);
    if (damage == Damage::loop_twice)
        faces.i32(2).i32(0).i32(0);
    else
        faces.i32(1).i32(0);
    faces.i32(0).i32(1).i32(0);
    all.u8(0x30).raw(list(none)).raw(list(curves)).raw(list(surfaces)).raw(list(vertices)).raw(list(edges));
    all.raw(list(trims)).raw(list(loops)).raw(list(faces)).nothing(48);
    return object(kBrep, all);
}

TEST(Rhino, edges_are_parts_of_their_curves_in_any_direction) {
    const Model m = read_hand_made({square_brep()});
    EXPECT_TRUE(m.refused.empty());
    ASSERT_EQ(m.faces.size(), 1u);
    EXPECT_TRUE(m.faces[0].reversed);
    EXPECT_EQ(m.vertices.size(), 4u);
    EXPECT_NEAR(area_of(m), 4, 1e-12);
    for (const Approximation& a : m.approximations) ADD_FAILURE() << a.what;
}

// The face is turned against its surface, whatever the entity of that has for a normal.
TEST(Rhino, normals_are_those_of_the_file_where_surfaces_are_made_another_way) {
    Written bent, sum;
    bent.u8(0x10).i32(3).f64s({0, 0, 0, 1, 0, 0, 2, 0, 0}).i32(3).f64s({0, 1, 2}).i32(3);
    sum.u8(0x10).nothing(24 + 48).raw(line({{0, 0, 0}}, {{0, 2, 0}})).raw(object(kPolyline, bent));
    for (const bool down : {false, true}) {
        const Model m = read_hand_made(
            {square_brep(Damage::none, down ? std::optional(object(kSum, sum)) : std::nullopt)});
        EXPECT_TRUE(m.refused.empty());
        const auto t = must(tessellate(m, {.tolerance = 1e-3}));
        EXPECT_NEAR(area_of(t.mesh), 4, 1e-12);
        for (std::size_t i = 0; i < t.mesh.triangles.size(); ++i) {
            const auto p = t.mesh.points_of(i);
            const auto at = [&](std::size_t k) { return t.mesh.points[std::size_t(p[k])]; };
            EXPECT_EQ(cross(at(1) - at(0), at(2) - at(0))[2] > 0, down);
        }
    }
}

TEST(Rhino, what_cannot_be_read_is_told_by_its_object) {
    const auto mesh = object(kMesh, Written().nothing(8)), note = object(kText, Written().nothing(8));
    const auto strange = object("01234567-89AB-CDEF-0123-456789ABCDEF", Written().nothing(8));
    const Model m = read_hand_made({square_brep(), mesh, mesh, note, strange, square_brep(Damage::trim)});
    EXPECT_EQ(m.faces.size(), 1u);
    ASSERT_EQ(m.refused.size(), 3u);
    EXPECT_NE(m.refused[0].message.find("01234567-89AB-CDEF-0123-456789ABCDEF"), std::string::npos);
    EXPECT_TRUE(m.refused[0].where.starts_with("object 4, byte ")) << m.refused[0].where;
    EXPECT_EQ(m.refused[1].message, "loop 0: trim 9 of 4");
    EXPECT_TRUE(m.refused[1].where.starts_with("object 5, byte "));
    EXPECT_EQ(m.refused[2].message, "mesh: 2 objects are left out");
    EXPECT_EQ(m.refused[2].where, "object 1");
    // Of what STEP's reader says nothing is left of its own numbers.
    Written far = object(kSum, Written().u8(0x10).nothing(24 + 48).raw(bump()).raw(
                                   row({bump(), line({{3, 0, 0}}, {{4, 0, 0}})})));
    const auto none = read_3dm(file({far}));
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, RefusalKind::unsupported);
    EXPECT_TRUE(none.error().where.starts_with("object 0, byte ")) << none.error().where;
    EXPECT_NE(none.error().message.find("sum of curves of several pieces"), std::string::npos);
}

// A loop that many faces name, and a curve of many points that many edges name, would grow like a square.
TEST(Rhino, what_is_named_many_times_takes_no_more_than_is_there) {
    using namespace freiform::rhino;
    BrepOf b;
    CurveInSpace curve;
    for (int i = 0; i < 100; ++i)
        curve.pieces.push_back({Line<3>{{{0.01 * i, 0, 0}}, {{0.01, 0, 0}}}, {0, 1}, {double(i), i + 1.0}});
    b.curves = {curve};
    b.vertices = {{{0, 0, 0}}, {{1, 0, 0}}};
    b.surfaces = {PlaneInSpace{{}, {{1, 0, 0}}, {{0, 1, 0}}, {}}};
    LoopOf loop;
    for (int i = 0; i < 10; ++i) {
        b.edges.push_back({{0, {}, i % 2 == 1}, {i % 2, 1 - i % 2}});
        loop.trims.push_back({i, false});
    }
    b.faces = {{0, false, {loop}}};
    StepText enough(1e-6), tight(1e-6, 1 << 20, 950);
    EXPECT_FALSE(must(enough.brep(b, "")).empty());
    EXPECT_TRUE(enough.refused.empty());
    EXPECT_TRUE(must(tight.brep(b, "")).empty());
    ASSERT_EQ(tight.refused.size(), 1u);
    EXPECT_EQ(tight.refused[0].kind, RefusalKind::limit);
    EXPECT_EQ(tight.refused[0].where, "face 0, edge 9");

    StepText short_text(1e-6, 3000);
    EXPECT_TRUE(must(short_text.brep(b, "")).empty());
    EXPECT_EQ(short_text.refused[0].kind, RefusalKind::limit);
    const auto twice = read_3dm(file({square_brep(Damage::loop_twice)}));
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().kind, RefusalKind::invalid);
    EXPECT_NE(twice.error().message.find("face 0: loop 0 has been used before"), std::string::npos);
    expect_refusal(read_3dm(file({square_brep(Damage::no_edges)})), RefusalKind::invalid, "object 0, face 0",
                   "none of its loops has an edge");
}

// Twelve stretched images of twelve of twelve ...: more than any file has objects.
TEST(Rhino, blocks_in_blocks_end_somewhere) {
    const auto id = [](int kind, int level, int i) {
        return text("0000000", kind, "-0000-0000-00", level, "0-0000000000", i < 10 ? "0" : "", i);
    };
    Written definitions, table;
    const auto add = [&](const Written& o, const std::string& uuid) {
        Written record, attributes;
        attributes.u8(0x10)
            .uuid(uuid)
            .i32(0)
            .i32(0)
            .nothing(4 + 2 + 2 + 8 + 8 + 4)
            .u8(3)
            .nothing(3)
            .wide(u"")
            .wide(u"");
        record.short_chunk(0x82000071, 0).raw(o).chunk(0x02008072, attributes).short_chunk(0x8200007F, 0);
        table.chunk(0x20008070, record);
    };
    const auto instance = [&](int of) {
        Written w;
        w.u8(0x10).uuid(id(2, of, 0)).f64s({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1}).nothing(48);
        return object("F9CFB638-B9D4-4340-87E3-C56E7865D96A", w);
    };
    constexpr int kLevels = 8, kEach = 12;
    for (int level = 0; level < kLevels; ++level) {
        Written d;
        d.u8(0x10).uuid(id(2, level, 0)).i32(kEach);
        for (int i = 0; i < kEach; ++i) {
            d.uuid(id(1, level, i));
            add(level + 1 == kLevels ? line({{0, 0, 0}}, {{1, 1, 1}}) : instance(level + 1), id(1, level, i));
        }
        d.wide(u"block");
        definitions.chunk(0x20008076, object("26F8BFF6-2618-417F-A158-153D64A94989", d));
    }
    Written record;
    record.short_chunk(0x82000071, 0).raw(instance(0));
    table.chunk(0x20008070, record).short_chunk(0xFFFFFFFF, 0);
    Written all;
    all.raw("3D Geometry File Format        4").chunk(0x10000021, definitions).chunk(0x10000013, table);
    StepReadOptions options;
    options.memory_bytes = 16 << 20;
    const auto m = read_3dm(all.bytes, options);
    ASSERT_FALSE(m);
    EXPECT_EQ(m.error().kind, RefusalKind::limit) << m.error().message;
}

TEST(Rhino, refuses_what_is_no_file_and_what_ends_early) {
    expect_refusal(read_3dm(""), RefusalKind::unreadable, "byte 0", "begins with");
    expect_refusal(read_3dm("3D Geometry File Format        x"), RefusalKind::unreadable, "byte 24",
                   "version");
    expect_refusal(read_3dm("3D Geometry File Format      900"), RefusalKind::unsupported, "byte 24",
                   "version 900");
    expect_refusal(read_3dm(file({})), RefusalKind::no_answer, "file", "0 objects");
    const std::string good = file({square_brep()});
    expect_refusal(read_3dm(std::string_view(good).substr(0, 200)), RefusalKind::unreadable, "byte 136",
                   "ends too early");
    // One bit of a coordinate.
    std::string damaged = good;
    const std::size_t at = damaged.find(Written().f64(6).bytes);
    ASSERT_NE(at, std::string::npos);
    damaged[at + 2] ^= 4;
    const auto r = read_3dm(damaged);
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error().kind, RefusalKind::unreadable);
    EXPECT_NE(r.error().message.find("checksum"), std::string::npos) << r.error().message;
}

// One bit of a number that no chunk inside has: of a path, an axis, a base point, a parameter.
TEST(Rhino, damage_between_the_parts_of_an_object_is_seen_too) {
    Written axis, sum;
    axis.u8(0x20).f64s({0, 0, 0, 0, 0, 77, 0.5, 2.5, 0, 1}).nothing(48).i32(0).u8(1);
    axis.raw(line({{2, 0, 0}}, {{1, 0, 3}}));
    sum.u8(0x10).f64s({0, 0, 77}).nothing(48).raw(bump()).raw(line({{0, 0, 0}}, {{0, 0, 2}}));
    Written list;
    list.u8(0x10).i32(1).nothing(8 + 48).i32(2).f64s({0, 77}).raw(bump());
    for (const Written& o : {object(kRevolved, axis), object(kSum, sum), object(kRow, list),
                             extrusion(square(2), false, 3, 0, 77)}) {
        std::string bytes = file({o});
        ASSERT_TRUE(read_3dm(bytes));
        const std::size_t at = bytes.find(Written().f64(77).bytes);
        ASSERT_NE(at, std::string::npos);
        bytes[at + 5] ^= 1;
        const auto r = read_3dm(bytes);
        ASSERT_FALSE(r);
        EXPECT_NE(r.error().message.find("checksum"), std::string::npos) << r.error().message;
    }
    // Of an instance: where it is.
    std::string blocks = bytes_of("blocks_8");
    const std::size_t at = blocks.find(Written().f64(30).bytes);
    ASSERT_NE(at, std::string::npos);
    blocks[at + 5] ^= 1;
    const Model m = must(read_3dm(blocks));
    EXPECT_EQ(m.bodies.size(), 4u);
    ASSERT_EQ(m.refused.size(), 1u);
    EXPECT_NE(m.refused[0].message.find("checksum"), std::string::npos);
}

// Version 1: two squares at a right angle, one edge of which the first has and the second shares.
Written v1_curve(int dim, const std::vector<double>& a, const std::vector<double>& b) {
    Written spline, row;
    spline.u8(dim).u8(0).u8(2).u16(2).u8(0).u8(0).nothing(std::size_t(16 * dim)).f64s({0, 1});
    for (const auto* p : {&a, &b})
        for (const double x : *p) spline.f64(x);
    spline.u16(0);
    row.u8(dim).u8(0).u16(1).nothing(std::size_t(16 * dim));
    row.chunk(0x00010009, Written().chunk(0x00010109, spline)).u16(0);
    return Written().chunk(0x00010008, Written().chunk(0x00010108, row));
}
Written v1_face(const std::array<std::vector<double>, 4>& p, int mated, bool has_edge) {
    Written face, surface, loop;
    surface.u8(3).u8(0).u8(1).u8(1).u16(1).u16(1).u8(0).u8(0).nothing(4 + 48).f64s({0, 1, 0, 1});
    for (const int i : {0, 3, 1, 2})
        for (const double x : p[std::size_t(i)]) surface.f64(x);
    surface.u16(0);
    const std::array<std::vector<double>, 4> flat{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    loop.i32(4).i32(0).nothing(32);
    for (int i = 0; i < 4; ++i) {
        const auto k = std::size_t(i), next = std::size_t((i + 1) % 4);
        const bool shared = i == mated;
        Written trim;
        const int flags = (shared ? 4 : 0) | (!shared || has_edge ? 1 : 0);
        trim.u8(flags)
            .i32(shared && !has_edge)
            .i32(0)
            .i32(0)
            .f64s({0, 0})
            .raw(v1_curve(2, flat[k], flat[next]));
        if ((flags & 1) != 0) trim.raw(v1_curve(3, p[k], p[next]));
        loop.chunk(0x00010006, Written().chunk(0x00010106, trim.u16(0)));
    }
    face.i32(0).i32(0).i32(3).nothing(48).i32(0);
    face.chunk(0x00010007, Written().chunk(0x00010107, surface));
    face.chunk(0x00010005, Written().chunk(0x00010105, loop.u16(0)));
    return Written().chunk(0x00010004, Written().chunk(0x00010104, face.u16(0)));
}

TEST(Rhino, version_1_has_faces_that_share_edges) {
    const std::vector<double> a{0, 0, 0}, b{2, 0, 0}, c{2, 2, 0}, d{0, 2, 0}, e{2, 2, 3}, f{0, 2, 3};
    Written shell, file, layer, layered;
    shell.i32(1).i32(2).nothing(48).i32(2).u16(1).u16(0);
    shell.raw(v1_face({a, b, c, d}, 2, true)).raw(v1_face({d, c, e, f}, 0, false)).u16(0);
    layer.chunk(0x00400011, Written().i32(5).raw("Ebene")).short_chunk(0xFFFFFFFF, 0);
    layered.short_chunk(0xA0000001, 0)
        .chunk(0x02000001, Written().i32(6).raw("M\xF6"
                                                "bius"))
        .chunk(0x00010103, shell);
    file.raw("3D Geometry File Format        1")
        .chunk(0x02000010, Written().i32(1).i32(8).f64s({1e-4, 0.01, 0.1}));
    file.chunk(0x00400010, layer)
        .chunk(0x00010003, layered)
        .raw(v1_curve(3, a, e))
        .chunk(0x00100001, Written().nothing(24));
    const Model m = must(read_3dm(file.bytes));
    EXPECT_EQ(m.unit, "inch");
    ASSERT_EQ(m.faces.size(), 2u);
    const ModelSummary s = summary(m);
    EXPECT_EQ(s.edges, 7);
    EXPECT_EQ(s.vertices, 6);
    EXPECT_EQ(s.open_edges, 6);
    EXPECT_NEAR(area_of(m), 4 + 6, 1e-12);
    ASSERT_EQ(m.bodies.size(), 1u);
    EXPECT_EQ(m.bodies[0].name, "Möbius");
    ASSERT_EQ(m.layers.size(), 1u);
    EXPECT_EQ(m.layers[0].name, "Ebene");
    ASSERT_EQ(m.refused.size(), 2u);
    EXPECT_EQ(m.refused[0].message, "1 curve that bounds no face is left out");
}

TEST(Rhino, answers_to_any_bytes) {
    std::vector<std::string> seeds{bytes_of("curves_7"), bytes_of("blocks_8"), bytes_of("sheets_4"),
                                   file({square_brep(), extrusion(square(2), false, 3)})};
    Random r(7);
    int models = 0, refusals = 0;
    for (int i = 0; i < 600; ++i) {
        std::string s = seeds[std::size_t(i) % seeds.size()];
        if (i % 5 == 0) s.resize(std::size_t(r.integer(0, int(s.size()))));
        for (int k = r.integer(0, 4); k > 0 && !s.empty(); --k) {
            const auto at = std::size_t(r.integer(0, int(s.size()) - 1));
            if (r.integer(0, 1) == 0)
                s[at] = char(r.integer(0, 255));
            else
                for (std::size_t b = at; b < std::min(at + 4, s.size()); ++b)
                    s[b] = char(r.integer(0, 1) * 255);
        }
        const auto m = read_3dm(s);
        if (m) {
            ++models;
            EXPECT_TRUE(make_model(*m));
        } else {
            ++refusals;
            EXPECT_FALSE(m.error().message.empty());
        }
    }
    EXPECT_GT(models, 50);
    EXPECT_GT(refusals, 50);
}

// As many faces as openNURBS finds (rhino3dm 8.35, of extrusions as its polysurfaces), and those closed that
// it calls solid.
TEST(Rhino, the_corpus_has_as_many_faces_as_openNURBS_finds) {
    FF_CORPUS_OR_SKIP(folder, "3dm");
    struct Known {
        std::string_view name;
        int faces, refused;
        bool closed;
    };
    for (const Known& k : {Known{"ayam_hyperbolid", 3, 0, false},
                           {"my_trimmed_surface", 1, 0, false},
                           {"v1_five_solids", 13, 0, true},
                           {"v2_Speeder", 2, 0, false},
                           {"v2_my_brep", 6, 0, true},
                           {"v3_Patch", 83, 0, false},
                           {"v3_T-Joint2", 18, 0, false},
                           {"v3_my_surfaces", 1, 0, false},
                           {"v4_Gear", 128, 0, true},
                           {"v4_MechPartA", 41, 0, true},
                           {"v4_SolidHandle", 37, 0, true},
                           {"v5_my_brep", 6, 0, true},
                           {"v5_ring", 21, 0, true},
                           {"v7_my_brep", 6, 0, true},
                           {"v7_rhino_logo_nurbs", 22, 0, true},
                           {"v8_section_hatch", 9, 0, true}}) {
        const auto d = read_any((folder / (std::string(k.name) + ".3dm")).string());
        ASSERT_TRUE(d) << d.error().where << d.error().message;
        const Model& m = std::get<Model>(d->objects.at(0).shape);
        int refused = 0;
        for (const Refusal& r : m.refused) refused += r.where != "file" ? 1 : 0;
        EXPECT_EQ(refused, k.refused) << k.name;
        EXPECT_EQ(int(m.faces.size()), k.faces - k.refused) << k.name;
        if (k.closed) EXPECT_EQ(summary(m).open_edges, 0) << k.name;
        if (!k.closed) continue;
        const Box<3> box = summary(m).box;
        const auto t = must(tessellate(m, {.tolerance = 1e-3 * norm(box.hi - box.lo)}));
        EXPECT_EQ(t.topology.open_edges, 0) << k.name;
        EXPECT_TRUE(t.refused.empty()) << k.name;
    }
}

}  // namespace
}  // namespace freiform::test::rhino
