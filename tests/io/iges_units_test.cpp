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
#include <support/solids.hpp>
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

}  // namespace
