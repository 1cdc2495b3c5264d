#include <freiform/io/document.hpp>
#include <freiform/io/obj_freeform.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/sew.hpp>
#include <freiform/model/spline_faces.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/model/tessellate.hpp>

#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

TEST(ObjFreeform, comes_back_to_the_bit) {
    const Document document = must(read_document(R"({"freiform": 1, "objects": [
        {"name": "a_curve", "type": "curve", "degree": 2, "knots": [0,0,0,0.3,1,1,1], "points": [[0.1,1,0],[1,2.2,3],[3,1,1],[4,0,1]]},
        {"name": "arc", "type": "curve", "degree": 2, "points": [[0,0,1],[1,0.3,1],[1,1,1.7]], "weights": [1,0.6,1]},
        {"name": "sheet", "type": "surface", "degrees": [2, 1], "knots": [[0,0,0,0.3,1,1,1],[0,0,2,2]],
         "points": [[[0.1,0,0.7],[0,1.1,0]],[[1e-3,0.2,1],[1,1,1.3]],[[2,0,0],[2,1,1e5]],[[3,0.1,0],[3,1,1]]]},
        {"name": "cut", "type": "trimmed", "surface": {"type": "surface", "degrees": [1, 2],
           "points": [[[0,0,0],[0,1,0.1],[0,2,0]],[[1,0,0],[1,1,0.7],[1,2,0]]], "weights": [[1,0.7,1],[1,0.3,1]]},
         "loops": [[{"degree": 1, "knots": [0,0,1,2,3,3], "points": [[0.1,0.1],[0.9,0.1],[0.5,0.9],[0.1,0.1]]}],
                   [{"degree": 2, "points": [[0.4,0.3],[0.5,0.2],[0.6,0.3]], "weights": [1,0.5,1]},
                    {"degree": 1, "points": [[0.6,0.3],[0.4,0.3]]}]]}]})"));
    const std::string obj = must(write_obj_freeform(document));
    const Document back = must(read_obj_freeform(obj));
    EXPECT_TRUE(back.left_out.empty());
    ASSERT_EQ(back.objects.size(), 4u);
    Document same = document;  // the points as they were given are not in the file
    for (Object& o : same.objects) o.given_points.clear();
    EXPECT_EQ(write_document(back), write_document(same));
    EXPECT_EQ(must(write_obj_freeform(back)), obj);
}

double area_and_volume(const Model& m, double& volume) {
    const auto t = tessellate(m, {.tolerance = 0.005});
    if (!t || !t->refused.empty()) return 0;
    double area = 0;
    for (std::size_t i = 0; i < t->mesh.triangles.size(); ++i) {
        const auto [a, b, c] = t->mesh.points_of(i);
        const auto at = [&](int k) { return t->mesh.points[std::size_t(k)]; };
        area += norm(cross(at(b) - at(a), at(c) - at(a))) / 2;
    }
    volume = std::abs(signed_volume(t->mesh));
    return area;
}

// Faces that are read again are those of the solid, and sewn they are the solid, with its seams.
TEST(ObjFreeform, solids_come_back_as_faces_that_fit) {
    const auto ring = loops_of({{ellipse({{5, 5}}, 2, 2), ellipse({{5.25, 5}}, 1, 0.5)}});
    const Axis about{{{0, 0, 0}}, {{0, 1, 0}}};
    const std::vector<Model> solids = {*prism(ring, {{1, 0.5, 2}}),
                                       *solid_of_revolution(ring, about, 1.5),
                                       *solid_of_revolution(ring, about, 2 * kPi),
                                       torus(3.0, 1.0),
                                       sphere({{1, 2, 3}}, 1),
                                       frustum(2, 1, 3)};
    for (std::size_t i = 0; i < solids.size(); ++i) {
        const auto bytes = write_obj_freeform({"mm", {{"part", solids[i]}}});
        ASSERT_TRUE(bytes) << bytes.error().where << ": " << bytes.error().message;
        const auto back = read_obj_freeform(*bytes);
        ASSERT_TRUE(back) << back.error().where << ": " << back.error().message;
        ASSERT_EQ(back->objects.size(), solids[i].faces.size());
        const auto faces = scene_of(*back);
        ASSERT_TRUE(faces);
        double volume = 0, sewn_volume = 0;
        const double area = area_and_volume(solids[i], volume);
        EXPECT_NEAR(area_and_volume(*faces, sewn_volume), area, 1e-2 * area) << i;
        const auto sewn = sew(*faces, {.tolerance = 1e-6});
        ASSERT_TRUE(sewn);
        EXPECT_EQ(summary(sewn->model).open_edges, 0);
        area_and_volume(sewn->model, sewn_volume);
        EXPECT_NEAR(sewn_volume, volume, 1e-2 * volume) << i;
    }
}

// A parameter curve that climbs while it turns has no rational image.
TEST(ObjFreeform, faces_cut_across_an_angle_are_refused) {
    Model m = frustum(2, 1, 3);
    m.faces.resize(1);
    m.faces[0].loops = {{{{0, false, segment({0, 1}, {{0, 0}}, {{1, 0.5}})}}}};
    test::expect_refusal(write_obj_freeform({"mm", {{"part", m}}}), RefusalKind::unsupported,
                         "objects[0] \"part\".faces[0]", "crosses the angle");
}

// The wall of a tube between two planes that are not across its axis: loops climb while they turn.
TEST(ObjFreeform, faces_cut_across_an_angle_are_written_within_a_tolerance) {
    const double slope = 0.4, r = 2, T = 2 * kPi;
    const auto step = [&](double z, int places) {  // z + slope cos u over u, and the ellipse in space
        std::vector<Vec<2>> uv;
        for (int i = 0; i <= places; ++i) {
            const double u = T * i / places;
            uv.push_back({{u, z + slope * r * std::cos(u)}});
        }
        return uv;
    };
    Model m = frustum(r, r, 1);
    m.faces.resize(1), m.shells[0].faces.resize(1), m.shells[0].closed = false, m.bodies[0].solid = false;
    for (const int top : {0, 1}) {
        const double z = 3.0 * top;
        const auto uv = step(z, 64);
        std::vector<double> knots{0};
        std::vector<Vec<2>> net{uv[0]};
        for (std::size_t i = 0; i + 1 < uv.size(); ++i) {
            const double a = uv[i][0], b = uv[i + 1][0], third = (b - a) / 3;
            knots.insert(knots.end(), 3, a);
            net.push_back({{a + third, uv[i][1] - third * slope * r * std::sin(a)}});
            net.push_back({{b - third, uv[i + 1][1] + third * slope * r * std::sin(b)}});
            net.push_back(uv[i + 1]);
        }
        knots.insert(knots.end(), 4, T);
        const int n = int(net.size());
        const CurveGeometry<2> flat =
            *Curve<Vec<2>>::make({*BSplineBasis::make(3, knots)}, Net<1, Vec<2>>({n}, net));
        m.edges[std::size_t(1 + top)].curve =
            Conic<3>{ConicKind::ellipse, {{0, 0, z}}, {{r, 0, slope * r}}, {{0, r, 0}}};
        m.vertices[std::size_t(top)].point = {{r, 0, z + slope * r}};
        for (Coedge& c : m.faces[0].loops[0].coedges) {
            const double u = jet<0>(c.curve, 0).value()[0];
            if (c.edge == 1 + top) c.curve = flat;
            if (c.edge == 0 && top) c.curve = segment({0, 3}, {{u, slope * r}}, {{u, 3 + slope * r}});
        }
    }
    m.edges[0].curve = Line<3>{{{r, 0, slope * r}}, {{0, 0, 1}}}, m.edges[0].range = {0, 3};
    m.faces[0].surface =
        Revolution{Line<3>{{{r, 0, 0}}, {{0, 0, 1}}}, {}, {{0, 0, 1}}, SurfaceKind::cylinder};
    m = *make_model(std::move(m));
    expect_refusal(write_obj_freeform({"mm", {{"part", m}}}), RefusalKind::unsupported,
                   "objects[0] \"part\".faces[0]", "crosses the angle");
    double last = 1;
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
        const auto written = write_obj_freeform({"mm", {{"part", m}}}, tolerance);
        ASSERT_TRUE(written) << written.error().where << ": " << written.error().message;
        EXPECT_GT(written->bound, 0);
        EXPECT_LE(written->bound, tolerance + 1e-6);  // the given curves are no better than some 1e-7
        EXPECT_LE(written->bound, last);
        last = written->bound;
        const auto back = read_obj_freeform(written->text);
        ASSERT_TRUE(back) << back.error().where << ": " << back.error().message;
        // Points of the loops are as near to the ellipses as is said.
        const auto& t = std::get<TrimmedSurface>(back->objects.at(0).shape);
        for (const auto& loop : t.loops)
            for (const auto& curve : loop)
                for (int i = 0; i <= 200; ++i) {
                    const Interval on = domain(curve)[0];
                    const Vec<2> uv = jet<0>(curve, on.lo + on.length() * i / 200).value();
                    const Vec<3> p =
                        std::visit([&](const auto& s) { return Vec<3>(s(uv[0], uv[1])); }, t.surface);
                    EXPECT_NEAR(std::hypot(p[0], p[1]), r, 1e-12);
                    const double below = p[2] - slope * p[0],
                                 off = std::min(std::abs(below), std::abs(below - 3));
                    const bool on_seam = std::abs(p[1]) < 1e-9 && p[0] > 0;
                    EXPECT_LE(on_seam ? 0 : off, 1.1 * written->bound);
                }
    }
    expect_refusal(write_obj_freeform({"mm", {{"part", m}}}, 0), RefusalKind::invalid, "tolerance");
}

TEST(ObjFreeform, closed_curves_are_cut_at_their_seam) {
    const Curve<Vec<3>> closed =
        Curve<Vec<3>>::trusted({must(BSplineBasis::periodic(2, std::vector<double>{0, 1, 2, 3}))},
                               Net<1, Vec<3>>({3}, {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}));
    const Document back = must(read_obj_freeform(must(write_obj_freeform({"", {{"c", closed}}}))));
    const auto& open = std::get<Curve<Vec<3>>>(back.objects[0].shape);
    EXPECT_FALSE(open.basis().is_closed());
    for (const double t : {0.0, 0.7, 1.9, 2.5}) EXPECT_LT(norm(open(t) - closed(t)), 1e-15);
}

// As the specification writes them: Bezier pieces with their breaks, indices from the end, lines that go on.
TEST(ObjFreeform, reads_bezier_pieces_parts_and_relative_indices) {
    const Document d =
        must(read_obj_freeform("cstype bezier\ndeg 2\r\nv 0 0 0\nv 1 1 0\nv 2 0 0 \\\n\nv 3 -1 0\nv 4 0 0\n"
                               "g two pieces\ncurv 0 2 -5 -4 -3 \\\n-2 -1\nparm u 0 1 2\nend\n"
                               "curv 0.5 1.5 1 2 3 4 5\nparm u 0 1 2\nend\nf 1 2 3\nf 1 2 4\n"));
    ASSERT_EQ(d.objects.size(), 2u);
    EXPECT_EQ(d.objects[0].name, "two pieces");
    const auto& c = std::get<Curve<Vec<3>>>(d.objects[0].shape);
    EXPECT_EQ(c(0.5), (Vec<3>{{1, 0.5, 0}}));
    EXPECT_EQ(c(1.5), (Vec<3>{{3, -0.5, 0}}));
    const auto& part = std::get<Curve<Vec<3>>>(d.objects[1].shape);
    EXPECT_EQ(part.basis().domain(), (Interval{0.5, 1.5}));
    EXPECT_EQ(part(1.5), c(1.5));
    ASSERT_EQ(d.left_out.size(), 1u);
    EXPECT_EQ(d.left_out[0].where, "line 17");
    // Of a surface the first parameter runs fastest.
    const Document s = must(
        read_obj_freeform("cstype bspline\ndeg 1 1\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 5\nv 1 1 5\nv 2 1 5\n"
                          "surf 0 2 0 1 1 2 3 4 5 6\nparm u 0 0 1 2 2\nparm v 0 0 1 1\nend\n"));
    EXPECT_EQ(std::get<Surface<Vec<3>>>(s.objects[0].shape)(2.0, 1.0), (Vec<3>{{2, 1, 5}}));
    EXPECT_EQ(std::get<Surface<Vec<3>>>(s.objects[0].shape)(1.0, 0.0), (Vec<3>{{1, 0, 0}}));
}

TEST(ObjFreeform, refuses_with_the_line) {
    const std::string head = "cstype rat bspline\ndeg 1\nv 0 0 0\nv 1 0 0 2\n";
    const auto refused = [&](const std::string& rest, RefusalKind kind, std::string_view where,
                             std::string_view what) {
        expect_refusal(read_obj_freeform(head + rest), kind, where, what);
    };
    refused("", RefusalKind::no_answer, "", "no curves");
    for (const char* none : {"", "\1\2 3\n"})
        expect_refusal(read_obj_freeform(none), RefusalKind::unreadable, "", "no line begins");
    refused("curv 0 1 1 2\nparm u 0 0 1 1\n", RefusalKind::unreadable, "line 6", "end");
    refused("curv 0 1 1 3\n", RefusalKind::unreadable, "line 5", "no index");
    refused("curv 1 0 1 2\n", RefusalKind::unreadable, "line 5", "from 1 to 0");
    refused("curv 0 1 1 2\nparm u 0 0 1\nend\n", RefusalKind::unreadable, "line 7", "need 4");
    refused("curv 0 1 1 2\nparm u 0 0 1 x\nend\n", RefusalKind::unreadable, "line 6", "number");
    refused("curv 0 1 1 2\nparm u 0 1 0 1\nend\n", RefusalKind::invalid, "line 7", "decrease");
    refused("v 0 0 0 -1\ncurv 0 1 1 3\nparm u 0 0 1 1\nend\n", RefusalKind::unsupported, "line 8", "weight");
    refused("cstype cardinal\n", RefusalKind::unsupported, "line 5", "cardinal");
    refused("deg 0\n", RefusalKind::unreadable, "line 5", "degree");
    refused("parm u 0 1\n", RefusalKind::unreadable, "line 5", "belongs");
    refused("trim 0 1 1\n", RefusalKind::unreadable, "line 5", "belong");
    refused("end\n", RefusalKind::unreadable, "line 5", "nothing");
    expect_refusal(
        read_obj_freeform(
            "deg 1 1\nv 0 0 0\ncstype bspline\nsurf 0 1 0 1 1 1 1\nparm u 0 0 1 1\nparm v 0 0 1 1\nend\n"),
        RefusalKind::unreadable, "line 7", "no grid");
    const Conic<2> round{ConicKind::ellipse, {{0.5, 0.5}}, {{0.2, 0}}, {{0, 0.2}}};
    const auto linear = must(BSplineBasis::bezier(1));
    const Surface<Vec<3>> square = must(Surface<Vec<3>>::make(
        {linear, linear}, Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}})));
    expect_refusal(write_obj_freeform({"", {{"", must(TrimmedSurface::make(square, {{round}}))}}}),
                   RefusalKind::unsupported, "objects[0].loops[0][0]", "ellipses");
}

TEST(ObjFreeform, any_bytes_are_read_or_refused) {
    const std::string good =
        "cstype rat bspline\ndeg 1 1\nv 0 0 0\nv 1 0 0 2\nv 1 1 1\nv 2 2 2\nvp 0 0\nvp 1 1\ndeg 1\n"
        "curv2 1 2\nparm u 0 0 1 1\nend\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 0 1 1\nparm v 0 0 1 "
        "1\nend\n";
    ASSERT_TRUE(read_obj_freeform(good));
    Random random(3);
    int read = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string bytes = good;
        for (int k = random.integer(1, 4); k > 0; --k)
            bytes[std::size_t(random.integer(0, int(good.size()) - 1))] =
                " \n0123456789-.\\uvpe"[random.integer(0, 18)];
        const auto document = read_obj_freeform(bytes);
        if (!document) continue;
        ++read;
        const Document again = must(read_obj_freeform(must(write_obj_freeform(*document))));
        ASSERT_EQ(again.objects.size(), document->objects.size());
        ASSERT_EQ(write_document(again), write_document(*document)) << bytes;
    }
    EXPECT_GT(read, 100);
    EXPECT_LT(read, 2900);
}

}  // namespace
}  // namespace freiform::test
