// Files whose coordinates have few digits: what is at a pole lies beside it, edges end beside each other and
// beside their surfaces, in any direction. Solids are written, turned and rounded in the text of the file,
// and read: no face is refused, none is taken for another, and no edge is left open.
#include <freiform/io/file.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/model/tessellate.hpp>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <support/corpus.hpp>
#include <support/random.hpp>
#include <support/solids.hpp>
#include <support/step_items.hpp>
#include <support/step_measures.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

using Turn = std::array<Vec<3>, 3>;  // its rows

Turn random_turn(Random& random) {
    double q[4], square = 0;
    for (double& x : q) x = random.real(-1, 1), square += x * x;
    for (double& x : q) x /= std::sqrt(square);
    const auto [w, x, y, z] = q;
    return {Vec<3>{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)}},
            Vec<3>{{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)}},
            Vec<3>{{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

// All points and directions in space of the file turned, and points with so many decimals, directions with
// three more.
std::string rounded(const std::string& file, const Turn& turn, int decimals) {
    std::string out;
    for (std::size_t at = 0; at < file.size();) {
        const std::size_t point = file.find("CARTESIAN_POINT(", at), way = file.find("DIRECTION(", at);
        const std::size_t found = std::min(point, way);
        if (found == file.npos) return out += file.substr(at);
        const std::size_t open = file.find("',(", found) + 3, close = file.find(')', open);
        out += file.substr(at, open - at);
        Vec<3> v{};
        int used = 0;
        const std::string numbers = file.substr(open, close - open);
        if (std::sscanf(numbers.c_str(), "%lf,%lf,%lf%n", &v[0], &v[1], &v[2], &used) == 3) {
            char text[120];
            std::string all;
            for (std::size_t i = 0; i < 3; ++i) {
                std::snprintf(text, sizeof text, "%.*f", decimals + (found == way ? 3 : 0), dot(turn[i], v));
                all += (i > 0 ? "," : "") + std::string(text);
            }
            out += all;
        } else {
            out += numbers;
        }
        at = close;
    }
    return out;
}

// Every vertex beside its place, by up to so much along each axis; curves and surfaces stay.
std::string with_moved_vertices(const std::string& file, Random& random, double by) {
    const auto number = [&](std::size_t& at) {
        std::size_t n = 0;
        while (at < file.size() && std::isdigit(static_cast<unsigned char>(file[at])))
            n = 10 * n + std::size_t(file[at++] - '0');
        return n;
    };
    std::map<std::size_t, Vec<3>> points;
    std::size_t last = 0;
    for (std::size_t at = 0; (at = file.find("\n#", at)) != file.npos;) {
        const std::size_t i = number(at += 2);
        last = std::max(last, i);
        const std::size_t end = file.find(';', at), open = file.find("',(", at);
        Vec<3> p{};
        if (file.compare(file.find_first_not_of(" =", at), 16, "CARTESIAN_POINT(") == 0 && open < end &&
            std::sscanf(file.c_str() + open + 3, "%lf,%lf,%lf", &p[0], &p[1], &p[2]) == 3)
            points[i] = p;
    }
    std::string out, more;
    std::size_t done = 0;
    for (std::size_t at = 0; (at = file.find("VERTEX_POINT(", at)) != file.npos;) {
        std::size_t of = file.find('#', at);
        out += file.substr(done, of + 1 - done);
        const auto p = points.find(number(++of));
        EXPECT_NE(p, points.end());
        out += text(++last);
        more += text("#", last, "=CARTESIAN_POINT('',(");
        for (int k = 0; k < 3; ++k) {
            char coordinate[40];
            std::snprintf(coordinate, sizeof coordinate, "%.17f", p->second[k] + random.real(-by, by));
            more += (k > 0 ? "," : "") + std::string(coordinate);
        }
        more += "));\n";
        at = done = of;
    }
    out += file.substr(done);
    return out.insert(out.rfind("ENDSEC;"), more);
}

struct Meshed {
    Tessellation mesh;
    std::vector<std::string> refused;
};
Meshed meshed(const std::string& file, double tolerance) {
    const auto model = read_step(file);
    if (!model) return {{}, {model.error().where + ": " + model.error().message}};
    Meshed out;
    for (const auto& r : model->refused) out.refused.push_back(r.where + ": " + r.message);
    TessellateOptions how;
    how.tolerance = tolerance;
    auto mesh = tessellate(*model, how);
    if (!mesh) return {{}, {mesh.error().where + ": " + mesh.error().message}};
    for (const auto& r : mesh->refused) out.refused.push_back(r.reason.where + ": " + r.reason.message);
    out.mesh = *std::move(mesh);
    return out;
}

Model turned(std::string_view region, double angle) {
    return must(solid_of_revolution(loops_of(parse_path_data(region).path), {{}, {{0, 1, 0}}}, angle));
}
std::string written(const Model& model) {
    Document document;
    document.unit = "mm";
    document.objects.push_back({"", model});
    return must(write_step(document));
}

TEST(StepDigits, turned_solids_with_poles_are_closed_whatever_their_points_are_rounded_to) {
    Random random(41);
    // Cones with their apex, balls, lemons, what a spline turns, and a cone on a ball.
    for (const char* region :
         {"M0 0 L20 0 L0 30 Z", "M0 -15 A15 15 0 0 1 0 15 Z", "M0 -20 A25 25 0 0 1 0 20 Z",
          "M0 0 C14 0 22 12 9 21 C4 25 8 33 0 33 Z", "M0 -12 A12 12 0 0 1 12 0 L0 25 Z"})
        for (const double angle : {2 * kPi, kPi, 1.9}) {
            const std::string file = written(turned(region, angle));
            const Meshed exact = meshed(file, 0.05);
            ASSERT_TRUE(exact.refused.empty()) << region << exact.refused[0];
            for (int i = 0; i < 12; ++i) {
                const int decimals = 3 + i % 3;
                const Meshed m = meshed(rounded(file, random_turn(random), decimals), 0.05);
                SCOPED_TRACE(text(region, ", ", angle, ", ", decimals, " decimals, ", i));
                EXPECT_TRUE(m.refused.empty()) << m.refused[0];
                const auto found = topology(m.mesh.mesh);
                EXPECT_EQ(found.open_edges, 0);
                EXPECT_EQ(found.misoriented_edges, 0);
                EXPECT_EQ(found.degenerate_triangles, 0);
                EXPECT_LT(m.mesh.mesh.triangles.size(), 1.6 * double(exact.mesh.mesh.triangles.size()));
                EXPECT_LT(m.mesh.boundary_gap, 6 * std::pow(10, -decimals));
                EXPECT_NEAR(signed_volume(m.mesh.mesh), signed_volume(exact.mesh.mesh),
                            0.02 * signed_volume(exact.mesh.mesh));
            }
        }
}

TEST(StepDigits, turned_solids_with_poles_are_closed_though_vertices_lie_beside_the_ends_of_edges) {
    Random random(43);
    for (const char* region :
         {"M0 0 L20 0 L0 30 Z", "M0 -15 A15 15 0 0 1 0 15 Z", "M0 -12 A12 12 0 0 1 12 0 L0 25 Z"})
        for (const double angle : {kPi, 1.9})
            for (const double by : {1e-5, 1e-3, 0.02}) {
                const std::string file = written(turned(region, angle));
                const Meshed exact = meshed(file, 0.05),
                             m = meshed(with_moved_vertices(file, random, by), 0.05);
                SCOPED_TRACE(text(region, ", ", angle, ", ", by));
                EXPECT_TRUE(m.refused.empty()) << m.refused[0];
                EXPECT_EQ(topology(m.mesh.mesh).open_edges, 0);
                EXPECT_EQ(topology(m.mesh.mesh).misoriented_edges, 0);
                EXPECT_LT(m.mesh.boundary_gap, 4 * by);
                EXPECT_LT(m.mesh.mesh.triangles.size(), 1.6 * double(exact.mesh.mesh.triangles.size()));
            }
}

// Corners of a square of side 3, each given twice, with the second one beside the first.
TEST(StepDigits, segments_that_end_beside_each_other_by_some_digits_are_one_boundary_and_it_is_told) {
    const auto file = [](double beside) {
        std::string s =
            "#8=SHAPE_REPRESENTATION('',(#9),#1);\n#9=GEOMETRIC_SET('',(#10));\n"
            "#10=CURVE_BOUNDED_SURFACE('',#7,(#11),.F.);\n"
            "#11=OUTER_BOUNDARY_CURVE('',(#500,#501,#502,#503),.F.);\n";
        constexpr Corner kAt[] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
        for (int i = 0; i < 4; ++i) {
            const Corner a = kAt[i], b = kAt[(i + 1) % 4];
            s += text("#", 100 + i, "=CARTESIAN_POINT('',(", a.x, ",", a.y, ",0.));\n#", 200 + i,
                      "=CARTESIAN_POINT('',(", b.x + beside, ",", b.y - beside, ",0.));\n#", 300 + i,
                      "=POLYLINE('',(#", 100 + i, ",#", 200 + i, "));\n#", 500 + i,
                      "=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#", 300 + i, ");\n");
        }
        return flat_file(s);
    };
    const Model exact = must(read_step(file(0))), digits = must(read_step(file(2.5e-4)));
    ASSERT_EQ(digits.faces.size(), 1u) << digits.refused[0].message;
    EXPECT_EQ(times_told(exact, "loops say that they are one"), 0);
    EXPECT_EQ(times_told(digits, "loops say that they are one"), 4);
    EXPECT_NEAR(area_of(digits), 9, 3e-3);
    // More than digits leave is a gap.
    const auto open = read_step(file(1e-3));
    ASSERT_TRUE(!open || open->faces.empty());
}

// Two edges on one spline that closes, or nearly: the first vertex is nearest to its end, or to its
// beginning.
TEST(StepDigits, edges_on_a_spline_that_closes_begin_and_end_as_their_sense_says) {
    const auto file = [](double open, double vertex) {
        return flat_file(
            text("#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
                 "#12=ADVANCED_FACE('',(#13),#7,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
                 "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#14=EDGE_LOOP('',(#15,#16));\n"
                 "#15=ORIENTED_EDGE('',*,*,#40,.T.);\n#16=ORIENTED_EDGE('',*,*,#41,.T.);\n"
                 "#40=EDGE_CURVE('',#17,#18,#19,.T.);\n#41=EDGE_CURVE('',#18,#17,#19,.T.);\n"
                 "#17=VERTEX_POINT('',#30);\n#18=VERTEX_POINT('',#22);\n"
                 "#19=B_SPLINE_CURVE_WITH_KNOTS('',1,(#20,#21,#22,#23,#24),.UNSPECIFIED.,.F.,.F.,"
                 "(2,1,1,1,2),(0.,1.,2.,3.,4.),.UNSPECIFIED.);\n#20=CARTESIAN_POINT('',(0.,0.,0.));\n"
                 "#21=CARTESIAN_POINT('',(2.,0.,0.));\n#22=CARTESIAN_POINT('',(2.,2.,0.));\n"
                 "#23=CARTESIAN_POINT('',(0.,2.,0.));\n#24=CARTESIAN_POINT('',(0.,",
                 open, ",0.));\n#30=CARTESIAN_POINT('',(0.,", vertex, ",0.));\n"));
    };
    for (const double open : {0.0, -1e-5, -4e-4, 4e-4})
        for (const double vertex : {0.0, -1e-3, 1e-3}) {
            SCOPED_TRACE(text(open, ", ", vertex));
            const Model m = must(read_step(file(open, vertex)));
            ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
            EXPECT_TRUE(m.refused.empty());
            EXPECT_EQ(m.edges.size(), 2u);
            EXPECT_NEAR(area_of(m, 1e-3), 4, 4e-3);
            // One edge, all around.
            const Model whole =
                must(read_step(replaced(replaced(file(open, vertex), "(#15,#16)", "(#15)"),
                                        "#40=EDGE_CURVE('',#17,#18", "#40=EDGE_CURVE('',#17,#17")));
            ASSERT_EQ(whole.faces.size(), 1u) << whole.refused[0].message;
            EXPECT_NEAR(whole.edges.at(0).range.length(), 4, 1e-12);
        }
}

// A patch between a bow of width 6, or a line, and a side at the tip, across `tip` and bent by ten times as
// much, where two straight edges meet, as far from both its corners.
TEST(StepDigits, sides_that_edges_hardly_miss_close_a_loop_along_themselves) {
    const auto file = [](double tip, double bow, double bend) {
        const auto at = [](int i, double x, double y, double z) {
            return text("#", i, "=CARTESIAN_POINT('',(", x, ",", y, ",", z, "));\n");
        };
        return flat_file(text(
            "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
            "#12=ADVANCED_FACE('',(#13),#70,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
            "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#14=EDGE_LOOP('',(#15,#16,#17));\n"
            "#15=ORIENTED_EDGE('',*,*,#40,.T.);\n#16=ORIENTED_EDGE('',*,*,#41,.T.);\n"
            "#17=ORIENTED_EDGE('',*,*,#42,.F.);\n#20=VERTEX_POINT('',#30);\n#21=VERTEX_POINT('',#33);\n"
            "#22=VERTEX_POINT('',#38);\n#40=EDGE_CURVE('',#20,#21,#50,.T.);\n"
            "#41=EDGE_CURVE('',#21,#22,#51,.T.);\n#42=EDGE_CURVE('',#20,#22,#52,.T.);\n",
            at(30, -3, 0, 0), at(31, -1, 0, bow), at(32, 1, 0, bow), at(33, 3, 0, 0), at(34, -tip / 2, 6, 0),
            at(35, -tip / 6, 6, bend * tip), at(36, tip / 6, 6, bend * tip), at(37, tip / 2, 6, 0),
            at(38, 0, 6, 0),
            "#50=B_SPLINE_CURVE_WITH_KNOTS('',3,(#30,#31,#32,#33),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),"
            ".UNSPECIFIED.);\n"
            "#51=LINE('',#33,#53);\n#53=VECTOR('',#54,1.);\n#54=DIRECTION('',(-3.,6.,0.));\n"
            "#52=LINE('',#30,#55);\n#55=VECTOR('',#56,1.);\n#56=DIRECTION('',(3.,6.,0.));\n"
            "#70=B_SPLINE_SURFACE_WITH_KNOTS('',3,1,((#30,#34),(#31,#35),(#32,#36),(#33,#37)),.UNSPECIFIED.,"
            ".F.,.F.,.F.,(4,4),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.);\n"));
    };
    Random random(3);
    for (const double tip : {1e-7, 2e-5, 6e-5})
        for (int i = 0; i < 6; ++i) {
            SCOPED_TRACE(text(tip, ", ", i));
            const Meshed m =
                meshed(i == 0 ? file(tip, 1, 10) : rounded(file(tip, 1, 10), random_turn(random), 12), 0.01);
            EXPECT_TRUE(m.refused.empty()) << m.refused[0];
            EXPECT_EQ(topology(m.mesh.mesh).degenerate_triangles, 0);
            EXPECT_LE(m.mesh.boundary_gap, tip + 1e-9);
        }
    // Three points of a straight edge, where the side is one of them, enclose nothing.
    for (const double tip : {6e-5, 1.2e-4})
        for (const double of_tip : {10.0, 5.0, 3.5, 2.5, 1.5, 1.0, 0.5}) {
            SCOPED_TRACE(text(tip, ", ", of_tip));
            const Meshed m = meshed(file(tip, 0, 5), of_tip * tip);
            EXPECT_TRUE(m.refused.empty()) << m.refused[0];
            EXPECT_EQ(topology(m.mesh.mesh).degenerate_triangles, 0);
        }
}

// One whose edges end as near to either corner of the side, to the last bit.
TEST(StepDigits, edges_end_at_the_corner_that_they_came_to) {
    FF_CORPUS_OR_SKIP(path, "step_micro/ap203_near_degenerate_nurbs_pole.stp");
    const std::string file = must(read_file(path.string(), 1u << 24));
    EXPECT_EQ(times_told(must(read_step(file)), "closes its loop"), 1);
    for (const double tolerance : {1.0, 0.1, 0.07, 0.03, 0.01}) {
        const Meshed m = meshed(file, tolerance);
        EXPECT_TRUE(m.refused.empty());
        EXPECT_EQ(topology(m.mesh.mesh).degenerate_triangles, 0);
        EXPECT_LE(m.mesh.boundary_gap, tolerance < 1 ? 0.075 + 1e-9 : 0.01);
    }
}

// Real models, with as many digits as others have written. One has a hole that touches the circle around it,
// and crosses that then.
TEST(StepDigits, models_of_the_corpus_lose_no_face_with_their_digits) {
    struct Of {
        const char* name;
        int decimals;
        double tolerance;
        std::size_t refused;  // at most
    };
    for (const Of& of : {Of{"step_micro/ap203_periodic_pole_solid.stp", 4, 0.02, 0},
                         Of{"step/trj4_k1_geo-tc-214.stp", 6, 0.005, 0},
                         Of{"step/ec_turbine-A.stp", 4, 0.12, 1}, Of{"step/trj7_b1-ec-214.stp", 4, 0.3, 0}}) {
        FF_CORPUS_OR_SKIP(path, of.name);
        const std::string file = must(read_file(path.string(), 1u << 24));
        const std::size_t as_it_is = meshed(file, of.tolerance).mesh.mesh.triangles.size();
        Random random(7);
        const Meshed m = meshed(rounded(file, random_turn(random), of.decimals), of.tolerance);
        EXPECT_LE(m.refused.size(), of.refused) << of.name;
        EXPECT_LT(m.mesh.mesh.triangles.size(), 1.3 * double(as_it_is)) << of.name;
        EXPECT_EQ(topology(m.mesh.mesh).misoriented_edges, 0) << of.name;
    }
}

// A closed spline whose vertex is beside it; half cones; a way to and fro between a hole and the outline.
TEST(StepDigits, models_of_the_corpus_lose_no_face_with_vertices_beside_their_edges) {
    struct Of {
        const char* name;
        double by, tolerance;
    };
    for (const Of& of :
         {Of{"step/t4mec.stp", 1.7e-5, 0.0017}, Of{"step/nist_ctc_04_asme1_ap242-e1.stp", 0.02, 2},
          Of{"step_micro/ap214_keyhole_loop.stp", 1e-4, 0.01}}) {
        FF_CORPUS_OR_SKIP(path, of.name);
        const std::string file = must(read_file(path.string(), 1u << 24));
        Random random(7);
        const Meshed exact = meshed(file, of.tolerance),
                     m = meshed(with_moved_vertices(file, random, of.by), of.tolerance);
        EXPECT_EQ(m.refused.size(), exact.refused.size()) << of.name << m.refused[0];
        EXPECT_LT(m.mesh.mesh.triangles.size(), 1.3 * double(exact.mesh.mesh.triangles.size())) << of.name;
        EXPECT_LT(m.mesh.boundary_gap, 4 * of.by + exact.mesh.boundary_gap) << of.name;
    }
}

}  // namespace
}  // namespace freiform::test
