// Names and colours of IGES files: what is written comes back, and those that the standard numbers are read.
#include "support/random.hpp"

#include <freiform/io/exchange.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/iges.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <unistd.h>

namespace {

using namespace freiform;
using test::must;
namespace fs = std::filesystem;

const std::string kLong =
    "a name that is longer than a card of sixty-four columns, with commas, semicolons; and "
    "\xc3\xa4\xc3\xb6\xc3\xbc";

Model bracket() {
    auto model = must(read_step(
        must(read_file((fs::path(FREIFORM_SOURCE_DIR) / "examples/bracket.step").string(), 1u << 24))));
    model.bodies[0].name = "bracket, left";
    model.bodies[0].colour = Colour{0.2, 0.4, 0.61, 1};
    for (Face& f : model.faces) f.name.clear(), f.colour.reset();
    model.faces[0].name = kLong;
    model.faces[1].name = "two\nlines";
    model.faces[1].colour = Colour{1, 0.5, 0.25, 1};
    model.faces[2].colour = Colour{1, 0.5, 0.25, 1};
    return model;
}

std::string written(Model model) {
    Document d;
    d.unit = "mm";
    d.objects.push_back({"", std::move(model)});
    return must(write_iges(d));
}

// The lines of a section, without the columns that number them.
std::vector<std::string> section(const std::string& file, char letter) {
    std::vector<std::string> out;
    std::istringstream lines(file);
    for (std::string line; std::getline(lines, line);)
        if (line.size() == 80 && line[72] == letter) out.push_back(line.substr(0, 72));
    return out;
}

class IgesLook : public ::testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists(FREIFORM_OCCT_BINARY)) GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
        ::setenv("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY, 1);
    }
    static Model read(const std::string& bytes) {
        const fs::path path = fs::temp_directory_path() / text("freiform-look-", ::getpid(), ".igs");
        std::ofstream(path, std::ios::binary) << bytes;
        auto model = must(read_with_occt(path.string()));
        fs::remove(path);
        return model;
    }
};

void expect_near(const std::optional<Colour>& a, const Colour& b) {
    ASSERT_TRUE(a);
    EXPECT_NEAR(a->r, b.r, 1e-12);
    EXPECT_NEAR(a->g, b.g, 1e-12);
    EXPECT_NEAR(a->b, b.b, 1e-12);
}

TEST(IgesFile, has_cards_of_80_columns_and_each_colour_once) {
    const std::string file = written(bracket());
    std::istringstream lines(file);
    for (std::string line; std::getline(lines, line);) EXPECT_EQ(line.size(), 80u) << line;
    int colours = 0, names = 0;
    std::multiset<int> used;
    const auto directory = section(file, 'D');
    for (std::size_t i = 0; i + 1 < directory.size(); i += 2) {
        const int type = std::stoi(directory[i].substr(0, 8));
        colours += type == 314, names += type == 406;
        if (const int c = std::stoi(directory[i + 1].substr(16, 8)); c != 0) {
            used.insert(c);
            ASSERT_LT(c, 0);
            EXPECT_EQ(std::stoi(directory[std::size_t(-c) - 1].substr(0, 8)), 314) << "it is one";
        }
    }
    EXPECT_EQ(colours, 2);
    EXPECT_EQ(names, 3);
    EXPECT_EQ(used.size(), 3u);
}

TEST_F(IgesLook, what_is_written_comes_back) {
    const Model model = bracket(), back = read(written(model));
    ASSERT_EQ(back.faces.size(), model.faces.size());
    ASSERT_EQ(back.bodies.size(), 1u);
    EXPECT_EQ(back.bodies[0].name, "bracket, left");
    expect_near(back.bodies[0].colour, *model.bodies[0].colour);
    EXPECT_EQ(back.faces[0].name, kLong);
    EXPECT_FALSE(back.faces[0].colour);
    EXPECT_EQ(back.faces[1].name, "two lines");
    for (const std::size_t f : {1u, 2u}) expect_near(back.faces[f].colour, Colour{1, 0.5, 0.25, 1});
    for (std::size_t f = 3; f < back.faces.size(); ++f) EXPECT_FALSE(back.faces[f].colour) << f;
}

// Curves and surfaces by themselves, a surface without loops among them, which is no part of anything then.
TEST_F(IgesLook, names_of_objects_come_back_with_them) {
    const auto basis = *BSplineBasis::clamped_uniform(1, 2);
    const auto flat = [&](double z) {
        return must(Surface<Vec<3>>::make(
            {basis, basis}, Net<2, Vec<3>>({2, 2}, {{{0, 0, z}}, {{0, 1, z}}, {{2, 0, z}}, {{2, 1, z}}})));
    };
    Document d;
    d.unit = "mm";
    d.objects.push_back({"first", flat(0)});
    d.objects.push_back({"second", TrimmedSurface{flat(5), {}}});
    const std::string file = must(write_iges(d));
    int independent = 0;
    for (const std::string& line : section(file, 'D'))
        independent += line.substr(0, 8) == "     128" && line.substr(64, 8) == "00000000";
    EXPECT_EQ(independent, 2);
    const Model back = read(file);
    ASSERT_EQ(back.bodies.size(), 2u);
    EXPECT_EQ(back.bodies[0].name, "first");
    EXPECT_EQ(back.bodies[1].name, "second");
    EXPECT_EQ(back.faces.size(), 2u);
}

TEST_F(IgesLook, colours_that_the_standard_numbers_are_read) {
    const Colour expected[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                               {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    for (int k = 1; k <= 8; ++k) {
        std::string file = written(bracket());
        std::size_t line = file.find("     510");  // of the directory, the second line of the first face
        ASSERT_NE(line, std::string::npos);
        line += 81;
        ASSERT_EQ(file.substr(line, 8), "     510");
        ASSERT_EQ(file[line + 72], 'D');
        file.replace(line + 16, 8, text("       ", k));
        const Model back = read(file);
        ASSERT_FALSE(back.faces.empty());
        const bool is_there = std::ranges::any_of(
            back.faces, [&](const Face& f) { return f.colour && *f.colour == expected[k - 1]; });
        EXPECT_TRUE(is_there) << k;
    }
}

}  // namespace
