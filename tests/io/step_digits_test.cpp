// Files whose coordinates have few digits: what is at a pole lies beside it, edges end beside each other and
// beside their surfaces, in any direction. Solids are written, turned and rounded in the text of the file,
// and read: no face is refused, none is taken for another, and no edge is left open.
#include <freiform/io/file.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/model/tessellate.hpp>

#include <cmath>
#include <cstdio>
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

}  // namespace
}  // namespace freiform::test
