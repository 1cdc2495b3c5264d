#include "run.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using TextJson = nlohmann::json;

class TextProgram : public Program {
protected:
    void SetUp() override {
        Program::SetUp();
        if (run({"--version", "--verbose"}).out.find(" font") == std::string::npos)
            GTEST_SKIP() << "built without fonts (FREIFORM_FONT)";
        if (run({"font", "DejaVu Sans"}).code != 0)
            GTEST_SKIP() << "no DejaVu Sans (tools/setup.sh demo installs it)";
    }
};

TEST_F(TextProgram, is_written_as_curves_and_pictures) {
    const std::vector<std::string> hello{"text", "Hi 8", "--font", "DejaVu Sans", "--size", "32"};
    const auto with = [&](std::vector<std::string> more) {
        std::vector<std::string> all = hello;
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    };
    const Ran svg = with({"-o", "a.svg", "--json"});
    ASSERT_EQ(svg.code, 0) << svg.err;
    const auto report = TextJson::parse(svg.out);
    EXPECT_EQ(report["glyphs"], 4);
    EXPECT_EQ(report["missing"].size(), 0u);
    EXPECT_EQ(content(path("a.svg")), with({}).out) << "SVG is what goes to standard output";
    ASSERT_EQ(with({"-o", "a.json"}).code, 0);
    // The H, the two parts of the i, and the 8 with its two counters; in the SVG the same.
    for (const char* file : {"a.json", "a.svg"}) {
        const auto info = TextJson::parse(run({"info", file, "--json"}).out);
        EXPECT_EQ(info["counts"]["curve"], 1 + 2 + 3) << file;
        EXPECT_NEAR(info["objects"][0]["box"]["min"][0].get<double>(), 32 * 201.0 / 2048, 1e-12) << file;
    }
    ASSERT_EQ(with({"-o", "a.pdf"}).code, 0);
    EXPECT_TRUE(content(path("a.pdf")).starts_with("%PDF"));
    ASSERT_EQ(with({"-o", "a.png"}).code, 0);
    EXPECT_TRUE(content(path("a.png")).starts_with("\x89PNG"));
    EXPECT_EQ(with({"-o", "a.step"}).code, 2);
    const Ran missing = run({"text", "\xf3\xb0\x80\x80", "--font", "DejaVu Sans", "-o", "b.svg"});
    EXPECT_EQ(missing.code, 0);
    EXPECT_NE(missing.err.find("no glyph for U+F0000"), missing.err.npos) << missing.err;
}

TEST_F(TextProgram, takes_features_in_one_word_or_in_several) {
    const auto with = [&](std::vector<std::string> features) {
        std::vector<std::string> all{"text", "AV fi", "--font", "DejaVu Sans", "--features"};
        all.insert(all.end(), features.begin(), features.end());
        const Ran r = run(all);
        EXPECT_EQ(r.code, 0) << r.err;
        return r.out;
    };
    EXPECT_EQ(with({"-liga,kern=0"}), with({"-liga", "kern=0"}));
    EXPECT_NE(with({"-liga,kern=0"}), with({"-liga"}));
}

TEST_F(TextProgram, with_contours_that_overlap_becomes_one_solid_for_each_letter) {
    const std::string inter = "/usr/share/fonts/truetype/inter-vf/Inter.var.ttf";
    if (!std::filesystem::exists(inter))
        GTEST_SKIP() << "no " << inter << " (tools/setup.sh test installs it)";
    const Ran sign = run({"text", "A#R", "--font", inter, "--size", "20", "--extrude", "3", "--tolerance",
                          "0.02", "-o", "sign.stl", "--json"});
    ASSERT_EQ(sign.code, 0) << sign.err;
    const auto report = TextJson::parse(sign.out);
    EXPECT_EQ(report["open_edges"], 0);
    EXPECT_LT(report["outline_bound"].get<double>(), 20e-6);
}

TEST_F(TextProgram, becomes_watertight_solids) {
    const Ran sign = run({"text", "B8i", "--font", "DejaVu Sans", "--size", "20", "--extrude", "3",
                          "--tolerance", "0.02", "-o", "sign.stl", "--json"});
    ASSERT_EQ(sign.code, 0) << sign.err;
    const auto report = TextJson::parse(sign.out);
    EXPECT_EQ(report["open_edges"], 0);
    EXPECT_LT(report["error_bound"].get<double>(), 0.02);
    EXPECT_EQ(content(path("sign.stl")).size(), 84 + 50 * report["triangles"].get<std::size_t>());
    const Ran ring = run({"text", "o", "--font", "DejaVu Sans", "--size", "20", "--revolve", "0,-30,1,0",
                          "--angle", "90", "-o", "ring.json"});
    ASSERT_EQ(ring.code, 0) << ring.err;
    const auto info = TextJson::parse(run({"info", "ring.json", "--json"}).out);
    EXPECT_EQ(info["objects"][0]["solids"], 1) << info;
    EXPECT_EQ(info["objects"][0]["open_edges"], 0) << info;
    EXPECT_EQ(run({"text", "o", "--font", "DejaVu Sans", "--extrude", "0"}).code, 2);
    EXPECT_EQ(run({"text", "o", "--font", "DejaVu Sans", "--extrude", "1", "--revolve", "0,-30,1,0"}).code,
              2);
    EXPECT_EQ(run({"text", "o", "--font", "DejaVu Sans", "--extrude", "1", "-o", "a.png"}).code, 2);
    EXPECT_EQ(run({"text", " ", "--font", "DejaVu Sans", "--extrude", "1", "-o", "a.stl"}).code, 1);
}

TEST_F(TextProgram, font_says_what_is_in_it) {
    const auto font = TextJson::parse(run({"font", "DejaVu Sans", "--json"}).out);
    EXPECT_EQ(font["family"], "DejaVu Sans");
    EXPECT_EQ(font["units_per_em"], 2048);
    EXPECT_EQ(font["axes"].size(), 0u);
    const auto a = TextJson::parse(run({"font", "DejaVu Sans", "--glyph", "U+0041", "--json"}).out);
    EXPECT_EQ(a["name"], "A");
    EXPECT_EQ(a["contours"], 2);
    for (const std::string& same : {std::string("A"), a["index"].dump()})
        EXPECT_EQ(TextJson::parse(run({"font", "DejaVu Sans", "--glyph", same, "--json"}).out), a);
    EXPECT_EQ(run({"font", "DejaVu Sans", "--glyph", "U+110000"}).code, 2);
    EXPECT_EQ(run({"font", "DejaVu Sans", "--glyph", "nonesuch"}).code, 1);
    EXPECT_EQ(run({"font", "No Such Family"}).code, 1);
    EXPECT_EQ(run({"font", file("no.ttf", "this is none")}).code, 3);
    EXPECT_EQ(run({"font", "DejaVu Sans", "--axis", "wght"}).code, 2);
    EXPECT_EQ(run({"font", "DejaVu Sans", "--axis", "wght=700"}).code, 3);
}

}  // namespace
}  // namespace freiform::test
