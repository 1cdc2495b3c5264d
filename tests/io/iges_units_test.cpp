// IGES files in other units than millimetres, whose solids have no parameter curves of their own: what is
// read of them is closed and as large as it is. The inputs are solids of tests, written by Open CASCADE.
#include <freiform/io/exchange.hpp>
#include <freiform/model/sew.hpp>
#include <freiform/model/tessellate.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <numbers>
#include <support/solids.hpp>
#include <support/step_measures.hpp>
#include <unistd.h>

namespace {

using namespace freiform;
namespace fs = std::filesystem;

const fs::path kFolder = fs::path(FREIFORM_SOURCE_DIR) / "tests/data/iges";

struct Solid {
    const char *name, *unit;
    int faces;
    double volume, area, tolerance;
};

class IgesUnits : public ::testing::TestWithParam<Solid> {
protected:
    void SetUp() override {
        if (!fs::exists(FREIFORM_OCCT_BINARY)) GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
        ::setenv("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY, 1);
    }
};

TEST_P(IgesUnits, solids_are_closed_and_have_their_size) {
    const Solid& x = GetParam();
    const auto read = read_with_occt((kFolder / x.name).string());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->unit, x.unit);
    EXPECT_EQ(int(read->faces.size()), x.faces);
    EXPECT_TRUE(read->refused.empty());
    for (const Edge& e : read->edges) EXPECT_LE(e.tolerance, 1e-6 * std::cbrt(x.volume));
    const auto sewn = sew(*read, {.tolerance = largest_tolerance(*read)});
    ASSERT_TRUE(sewn) << sewn.error().message;
    EXPECT_EQ(summary(sewn->model).open_edges, 0);
    const auto made = tessellate(sewn->model, {.tolerance = x.tolerance});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made->refused.empty());
    EXPECT_EQ(made->topology.open_edges, 0);
    EXPECT_LE(made->boundary_gap, x.tolerance / 100);
    EXPECT_NEAR(test::signed_volume(made->mesh), x.volume, x.area * x.tolerance);
}

// Volumes and areas are those of the solids before they were written.
INSTANTIATE_TEST_SUITE_P(Files, IgesUnits,
                         ::testing::Values(Solid{"revolved_inch.iges", "inch", 2,
                                                 1056.89 / (25.4 * 25.4 * 25.4), 531.791 / (25.4 * 25.4),
                                                 1e-3},
                                           Solid{"cut_cone_cm.iges", "cm", 5, 1555.17, 918.06, 0.02}),
                         [](const auto& parameter) { return std::string(parameter.param.unit); });

// What a file says that its edges may be off by is their tolerance.
TEST_F(IgesUnits, the_resolution_of_the_file_is_the_tolerance_of_its_edges) {
    std::ifstream in(kFolder / "revolved_inch.iges", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const std::string_view stated = "3.93701E-09";
    const std::size_t at = bytes.find(stated);
    ASSERT_NE(at, std::string::npos);
    const fs::path path = fs::temp_directory_path() / text("freiform-resolution-", ::getpid(), ".iges");
    std::ofstream(path, std::ios::binary) << std::string(bytes).replace(at, stated.size(), "3.93701E-05");
    const auto read = read_with_occt(path.string());
    ASSERT_TRUE(read) << read.error().message;
    for (const Edge& e : read->edges) EXPECT_NEAR(e.tolerance, 3.93701e-5, 1e-12);
    fs::remove(path);
}

// What files and their reader leave behind, once each: ends of edges beside the vertices they share, twice
// the tolerance from one to the other; an edge that lies in such a gap, and that one face has alone; a seam
// whose two sides are one in the parameters, all of it, or one of two, or half; parameter curves that are not
// those of the edges. All of it is closed.
TEST_F(IgesUnits, gaps_at_vertices_and_seams_in_one_place_are_closed) {
    const Solid solids[] = {{"ends_beside_vertices.iges", "cm", 14, 2.684877, 12.91348, 0.004},
                            {"short_edge_in_a_gap.iges", "mm", 7, 5979.542, 2022.323, 0.05},
                            {"seam_in_one_place.iges", "mm", 1, 798.0574, 452.1391, 0.02},
                            {"curves_in_space.iges", "mm", 9, 4.50617, 34.2131, 0.004},
                            {"edge_without_length.iges", "mm", 4, 348.918, 426.053, 0.02},
                            {"ring_of_one_seam.iges", "mm", 1, 196.112, 284.150, 0.02},
                            {"ball_of_half_a_seam.iges", "mm", 5, 560.144, 537.546, 0.02}};
    for (const Solid& x : solids) {
        SCOPED_TRACE(x.name);
        const auto read = read_with_occt((kFolder / x.name).string());
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->unit, x.unit);
        EXPECT_EQ(int(read->faces.size()), x.faces);
        EXPECT_TRUE(read->refused.empty());
        const bool told = std::ranges::any_of(read->approximations, [](const Approximation& a) {
            return a.what.find("those in space are taken") != a.what.npos;
        });
        EXPECT_EQ(told, std::string_view(x.name) == "curves_in_space.iges");
        const auto sewn = sew(*read, {.tolerance = largest_tolerance(*read)});
        ASSERT_TRUE(sewn) << sewn.error().message;
        EXPECT_TRUE(sewn->remaining.empty());
        EXPECT_EQ(summary(sewn->model).open_edges, 0);
        const auto made = tessellate(sewn->model, {.tolerance = x.tolerance});
        ASSERT_TRUE(made) << made.error().message;
        EXPECT_TRUE(made->refused.empty());
        EXPECT_EQ(made->topology.open_edges + made->topology.non_manifold_edges, 0);
        EXPECT_LE(made->boundary_gap, x.tolerance);
        EXPECT_NEAR(test::signed_volume(made->mesh), x.volume, x.area * x.tolerance);
    }
}

// The reader joins parameter curves that are a turn apart by edges around the whole surface.
TEST_F(IgesUnits, no_face_covers_its_surface_more_than_once) {
    const auto read = read_with_occt((kFolder / "full_turns_too_many.iges").string());
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->faces.size(), 1u);
    ASSERT_EQ(read->faces[0].loops.size(), 1u);
    EXPECT_EQ(read->faces[0].loops[0].coedges.size(), 4u);
    // A quarter of a cylinder: its radius times pi / 2 times its length.
    EXPECT_NEAR(test::area_of(*read, 1e-6), 0.02923075455 * (std::numbers::pi / 2) * 0.407471797, 1e-6);
}

// The reader takes one side of the seam for the other, so that the parts of the window on both sides reach
// out.
TEST_F(IgesUnits, windows_across_the_seam_of_a_torus_are_left_out) {
    const auto read = read_with_occt((kFolder / "window_across_a_seam.iges").string());
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->faces.size(), 1u);
    const auto sewn = sew(*read, {.tolerance = largest_tolerance(*read)});
    ASSERT_TRUE(sewn) << sewn.error().message;
    EXPECT_EQ(summary(sewn->model).seams, 3);
    // Of radii 5 and 1, without a window half a radian wide and from z = -0.5 to z = 0.4.
    const double lo = std::asin(-0.5), hi = std::asin(0.4);
    EXPECT_NEAR(
        test::area_of(sewn->model, 1e-3),
        20 * std::numbers::pi * std::numbers::pi - 0.5 * (5 * (hi - lo) + std::sin(hi) - std::sin(lo)), 0.05);
}

// Far from 0 a seam lies beside its place by more than rounding, so that the wall is longer than a turn: the
// circles at its ends are no turns too many for that.
TEST_F(IgesUnits, walls_with_windows_far_away_keep_their_rims) {
    const auto read = read_with_occt((kFolder / "window_in_a_wall_far_away.iges").string());
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->faces.size(), 1u);
    EXPECT_EQ(read->faces[0].loops[0].coedges.size(), 8u);
    // By Open CASCADE's integration; without the window 2 pi 6.526409 39.252972, which is 1609.63.
    EXPECT_NEAR(test::area_of(*read, 1e-4), 1555.564, 0.02);
}

// What a refused face leaves behind would make the box of the model, and its largest tolerance, those of
// that.
TEST_F(IgesUnits, nothing_of_a_refused_face_stays) {
    const auto read = read_with_occt((kFolder / "corner_far_away.iges").string());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->faces.size(), 1u);
    EXPECT_EQ(read->refused.size(), 1u);
    EXPECT_EQ(read->edges.size(), 4u);
    EXPECT_EQ(read->vertices.size(), 4u);
    EXPECT_LT(summary(*read).box.diagonal(), 2.5);
    EXPECT_LT(largest_tolerance(*read), 1e-5);
}

}  // namespace
