#include "run.hpp"
#include "support/corpus.hpp"

#include <freiform/io/svg.hpp>
#include <freiform/region/boolean.hpp>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace freiform::test {
namespace {

class PathCommand : public Program {
protected:
    Ran command(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "path");
        return run(arguments);
    }
    nlohmann::json report(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"-o", "out.svg", "--json"});
        const Ran r = command(arguments);
        EXPECT_EQ(r.code, 0) << r.err << r.out;
        return nlohmann::json::parse(r.out);
    }
    std::string drawing(const std::string& name, const std::string& shapes) {
        return file(name,
                    "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10 10\">" + shapes + "</svg>");
    }
};

const std::string kSquares =
    R"(<rect id="a" width="4" height="4" fill="red"/><rect id="b" x="2" y="2" width="5" height="4"/>)";

TEST_F(PathCommand, combines_the_shapes_of_one_file) {
    const auto f = drawing("two.svg", kSquares);
    EXPECT_EQ(report({"union", f})["area"], 32);
    EXPECT_EQ(report({"intersection", f})["area"], 4);
    EXPECT_EQ(report({"difference", f})["area"], 12);
    EXPECT_EQ(report({"exclusion", f})["area"], 28);
    EXPECT_EQ(report({"difference", f, "--objects", "b"})["area"], 20);
    const auto made = read_svg(content(path("out.svg")));
    ASSERT_TRUE(made);
    ASSERT_EQ(made->shapes.size(), 1u);
    EXPECT_EQ(made->shapes[0].id, "difference");
    EXPECT_EQ(signed_area(made->shapes[0].path).value, 20);
}

TEST_F(PathCommand, combines_two_files_each_as_a_whole) {
    const auto a = drawing("two.svg", kSquares), b = drawing("disc.svg", R"(<circle cx="3" cy="3" r="1"/>)");
    const auto r = report({"difference", a, b});
    EXPECT_NEAR(r["area"].get<double>(), 32 - std::numbers::pi, 1e-12);
    EXPECT_LE(r["error_bound"], r["tolerance"]);
    EXPECT_EQ(r["loops"], 2);
    const auto made = read_svg(content(path("out.svg")));
    ASSERT_TRUE(made && made->shapes.size() == 1);
    EXPECT_EQ(made->shapes[0].fill, "red");
}

TEST_F(PathCommand, turns_strokes_into_shapes_that_are_filled) {
    const auto f = drawing(
        "line.svg", R"(<path d="M1 1H5" stroke="blue" fill="none" stroke-linecap="square" stroke-width="2"/>)"
                    R"(<rect width="1" height="1"/>)");
    const auto r = report({"stroke", f});
    EXPECT_NEAR(r["area"].get<double>(), 12, 1e-9);  // that of the line
    const auto made = read_svg(content(path("out.svg")));
    ASSERT_TRUE(made);
    ASSERT_EQ(made->shapes.size(), 2u);
    EXPECT_EQ(made->shapes[0].fill, "blue");
    EXPECT_EQ(made->shapes[0].stroke, "none");
    EXPECT_NEAR(
        report({"stroke", f, "--width", "1", "--cap", "butt", "--dashes", "1,1"})["area"].get<double>(),
        2 + 2, 1e-6);
}

TEST_F(PathCommand, makes_shapes_larger_and_smaller) {
    const auto f = drawing("two.svg", kSquares);
    EXPECT_NEAR(report({"offset", f, "--distance", "1", "--join", "miter"})["area"].get<double>(), 36 + 42,
                1e-9);
    EXPECT_NEAR(report({"offset", f, "--distance", "-1"})["area"].get<double>(), 4 + 6, 1e-9);
}

TEST_F(PathCommand, takes_documents_and_writes_them) {
    const auto f = file(
        "c.json",
        R"({"type": "curve", "degree": 1, "knots": [0,0,1,2,3,3], "points": [[0,0],[3,0],[0,4],[0,0]]})");
    const Ran r = command({"union", f, "--to", "json"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(nlohmann::json::parse(r.out)["objects"][0]["points"].size(), 4u) << r.out;
}

// Copies that are a last bit beside each other, crossings at small angles, lenses thinner than numbers tell.
TEST_F(PathCommand, unites_the_shapes_of_the_tiger_at_a_billionth_of_its_size) {
    FF_CORPUS_OR_SKIP(tiger, "svg/Ghostscript_Tiger.svg");
    const auto fine = report({"union", tiger.string()});
    const auto coarse = report({"union", tiger.string(), "--tolerance", "1e-4"});
    EXPECT_LT(fine["tolerance"], 3e-7);
    EXPECT_LE(fine["error_bound"], fine["tolerance"]);
    EXPECT_EQ(fine["loops"], 8);
    EXPECT_NEAR(fine["area"], coarse["area"], 1e-3);
}

TEST_F(PathCommand, names_both_shapes_that_are_not_told_apart) {
    FF_CORPUS_OR_SKIP(tiger, "svg/Ghostscript_Tiger.svg");
    const Ran r = command({"union", tiger.string(), "--tolerance", "1e-8", "-o", path("none.svg")});
    EXPECT_EQ(r.code, 1);
    EXPECT_NE(
        r.err.find("path 63: loops[0].segments[8]: and path 67: loops[0].segments[8] run along each other"),
        std::string::npos)
        << r.err;
    EXPECT_NE(r.err.find("near (41.32"), std::string::npos) << r.err;
}

TEST_F(PathCommand, says_what_is_wrong) {
    const auto f = drawing("two.svg", kSquares);
    EXPECT_EQ(command({"unite", f}).code, 2);
    EXPECT_EQ(command({"stroke", f, f}).code, 2);
    EXPECT_EQ(command({"offset", f}).code, 2);
    EXPECT_EQ(command({"union", f, "--tolerance", "0"}).code, 2);
    EXPECT_EQ(command({"union", f, "--to", "png"}).code, 2);
    EXPECT_EQ(command({"union", f, "--objects", "c"}).code, 1);
    EXPECT_EQ(command({"union", path("none.svg")}).code, 5);
    const Ran r = command({"union", f, "--tolerance", "1e-17", "--json"});
    EXPECT_EQ(r.code, 1);
    EXPECT_EQ(nlohmann::json::parse(r.out)["error"]["kind"], "ill_conditioned");
}

TEST_F(PathCommand, simplifies_each_shape) {
    std::string d = "M 2 0";
    for (int i = 1; i <= 400; ++i)
        d += " L " + std::to_string(2 * std::cos(i * 6.283185307179586 / 400)) + " " +
             std::to_string(2 * std::sin(i * 6.283185307179586 / 400));
    file("traced.svg", "<svg><path id='ring' fill='none' stroke='red' d='" + d + "'/></svg>");
    const Ran ran =
        run({"path", "simplify", "traced.svg", "--tolerance", "0.001", "-o", "few.svg", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto said = nlohmann::json::parse(ran.out);
    EXPECT_LE(said["segments"].get<int>(), 8);
    EXPECT_LE(said["error_bound"].get<double>(), 0.001);
    EXPECT_NEAR(said["area"].get<double>(), -4 * 3.14159265358979, 0.01);  // y is turned up
    EXPECT_NE(content(path("few.svg")).find("stroke=\"red\""), std::string::npos);
}

}  // namespace
}  // namespace freiform::test
