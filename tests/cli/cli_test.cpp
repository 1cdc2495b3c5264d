#include "run.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <support/corpus.hpp>
#include <support/sanitizer.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;

const std::string kCurve =
    R"({"freiform": 1, "unit": "mm", "objects": [{"name": "c1", "type": "curve", "degree": 3,
  "knots": [0,0,0,0,1,1,1,1], "points": [[0,0],[1,2],[3,2],[4,0]], "weights": [1,1,1,1]}]})";
const std::string kSurface =
    R"({"type": "surface", "degrees": [1,2], "points": [[[0,0,0],[0,1,0],[0,2,1]],[[1,0,0],[1,1,3],[1,2,0]]]})";

using Cli = Program;

void expect_error(const Ran& r, int code, const std::string& kind, const std::string& where,
                  const std::string& message) {
    EXPECT_EQ(r.code, code) << r.err;
    const Json error = Json::parse(r.out, nullptr, false).value("error", Json::object());
    EXPECT_EQ(error.value("kind", ""), kind) << r.out;
    EXPECT_NE(error.value("where", "").find(where), std::string::npos) << r.out;
    EXPECT_NE(error.value("message", "").find(message), std::string::npos) << r.out;
    EXPECT_TRUE(r.err.starts_with("freiform: ")) << r.err;
}

TEST_F(Cli, knots_inserted_for_weights_that_are_not_positive_are_said_with_a_bound) {
    const std::string half =
        R"({"type":"curve","name":"half","points":[[0.3,0],[0,0.3],[-0.3,0]],"weights":[1,0,1],
        "weighted_points":[[0.3,0],[0,0.3],[-0.3,0]]})";
    const Ran r = run({"info", "-", "--json"}, half);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json a = Json::parse(r.out)["objects"][0]["approximations"];
    ASSERT_EQ(a.size(), 1u);
    EXPECT_EQ(a[0]["what"], "1 knot inserted to make all weights positive");
    EXPECT_GT(a[0]["bound"].get<double>(), 0);
    EXPECT_LT(a[0]["bound"].get<double>(), 1e-14);
    EXPECT_NE(r.err.find("objects[0] \"half\": 1 knot inserted"), std::string::npos) << r.err;
    EXPECT_NE(run({"info", "-"}, half).out.find("  approximated  1 knot inserted"), std::string::npos);
    EXPECT_NE(run({"length", "-"}, half).err.find("1 knot inserted"), std::string::npos);
    EXPECT_EQ(run({"info", "-"}, R"({"type":"curve","points":[[0],[1]],"weights":[1,2]})").err, "");
}

TEST_F(Cli, info_says_what_a_file_contains) {
    const Ran r = run({"info", file("c.json", kCurve)});
    EXPECT_EQ(r.code, 0);
    EXPECT_EQ(r.err, "");
    for (const char* part : {"unit mm", "\"c1\": curve", "degree   3, 4 points of 2 coordinates, rational",
                             "[0, 1]", "[0, 4] x [0, 2]"})
        EXPECT_NE(r.out.find(part), std::string::npos) << r.out;
    const Json j = Json::parse(run({"info", kTeapot, "--json"}).out);
    EXPECT_EQ(j["counts"]["surface"], 32);
    EXPECT_EQ(j["objects"].size(), 32u);
    EXPECT_EQ(j["objects"][0]["degrees"], Json::parse("[3,3]"));
    EXPECT_EQ(j["objects"][0]["domain"], Json::parse("[[0,1],[0,1]]"));
}

TEST_F(Cli, eval_gives_points_and_derivatives) {
    const Ran r = run({"eval", "-", "--at", "0.5;0;1", "--derivatives", "3"}, kCurve);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json results = Json::parse(r.out)["results"];
    ASSERT_EQ(results.size(), 3u);
    EXPECT_EQ(results[0]["at"], Json::parse("[0.5]"));
    EXPECT_EQ(results[0]["point"], Json::parse("[2.0,1.5]"));
    EXPECT_EQ(results[0]["derivatives"], Json::parse("[[4.5,0.0],[0.0,-12.0],[-12.0,0.0]]"));
    EXPECT_EQ(results[2]["point"], Json::parse("[4.0,0.0]"));

    // S(u, v) of kSurface: x = u, y = 2 v, z = (1-u) v^2 + 6 u v (1-v).
    const Json s =
        Json::parse(run({"eval", "-", "--at", "0.25,0.5", "--derivatives", "2"}, kSurface).out)["results"][0];
    EXPECT_EQ(s["point"], Json::parse("[0.25,1.0,0.5625]"));
    EXPECT_EQ(s["derivatives"], Json::parse("[[1,0,1.25],[0,2,0.75],[0,0,0],[0,0,-1],[0,0,-1.5]]")) << s;
}

TEST_F(Cli, eval_gives_values_to_the_last_digit_with_their_bounds) {
    // (4 t - 3)^3
    const std::string cubed = R"({"type": "curve", "points": [[-27], [9], [-3], [1]]})";
    const double d = 4 * 0.7501 - 3, right = d * d * d;
    const Json r = Json::parse(run({"eval", "-", "--at", "0.7501", "--accurate"}, cubed).out)["results"][0];
    EXPECT_NEAR(r["point"][0].get<double>(), right, 4e-16 * right);
    EXPECT_LE(r["bound"][0].get<double>(), 2e-16 * right);
    EXPECT_GT(r["bound"][0].get<double>(), 0);
    const Json plain = Json::parse(run({"eval", "-", "--at", "0.7501"}, cubed).out)["results"][0];
    EXPECT_FALSE(plain.contains("bound"));
    EXPECT_GT(std::abs(plain["point"][0].get<double>() - right), 1e-8 * right);
}

TEST_F(Cli, eval_takes_parameters_from_a_file) {
    file("p.csv", "u,v\n0.25, 0.5\r\n\n# a comment\n1,0\n");
    const Json r = Json::parse(run({"eval", "-", "--at", "@p.csv"}, kSurface).out)["results"];
    ASSERT_EQ(r.size(), 2u);
    EXPECT_EQ(r[1]["point"], Json::parse("[1,0,0]"));
    file("bad.csv", "0,0\n0,x\n");
    expect_error(run({"eval", "-", "--at", "@bad.csv", "--json"}, kSurface), 3, "unreadable",
                 "bad.csv: line 2", "expected finite numbers");
    EXPECT_EQ(run({"eval", "-", "--at", "@missing.csv"}, kSurface).code, 5);
}

TEST_F(Cli, eval_names_the_parameter_that_is_outside) {
    expect_error(run({"eval", "-", "--at", "0.5;1.5", "--json"}, kCurve), 1, "out_of_domain", "at[1]",
                 "[0, 1]");
    expect_error(run({"eval", "-", "--at", "0.5,2", "--json"}, kSurface), 1, "out_of_domain", "at[0][1]",
                 "[0, 1]");
    expect_error(run({"eval", "-", "--at", "0.5", "--json"}, kSurface), 1, "no_answer", "at[0]",
                 "has 2 parameters");
}

TEST_F(Cli, eval_asks_all_objects_or_the_one_that_is_named) {
    const Json all = Json::parse(run({"eval", kTeapot, "--at", "0,0"}).out)["results"];
    ASSERT_EQ(all.size(), 32u);
    EXPECT_EQ(all[7]["object"], 7);
    const Json one = Json::parse(run({"eval", kTeapot, "--at", "0,0", "--object", "7"}).out)["results"];
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0], all[7]);
    expect_error(run({"eval", kTeapot, "--at", "0,0", "--object", "x", "--json"}), 1, "no_answer", "--object",
                 "0..31");
}

TEST_F(Cli, convert_changes_the_format_and_nothing_else) {
    ASSERT_EQ(run({"convert", kTeapot, "-o", "t.json"}).code, 0);
    ASSERT_EQ(run({"convert", "t.json", "-o", "t.bpt"}).code, 0);
    ASSERT_EQ(run({"convert", "t.bpt", "-o", "u.json"}).code, 0);
    EXPECT_EQ(content(path("t.json")), content(path("u.json")));
    const Ran r = run({"convert", "-", "--to", "bpt"}, kSurface);
    EXPECT_EQ(r.out, "1\n1 2\n0 0 0\n0 1 0\n0 2 1\n1 0 0\n1 1 3\n1 2 0\n");
    expect_error(run({"convert", "-", "--to", "bpt", "--json"}, kCurve), 1, "no_answer", "objects[0] \"c1\"",
                 "Bezier patches");
}

TEST_F(Cli, convert_keeps_the_shape_while_it_changes_splines) {
    const auto at = [&](const std::string& document, const std::string& u) {
        const Ran r = run({"eval", "-", "--at", u}, document);
        return Json::parse(r.out, nullptr, false)["results"][0]["point"].get<std::vector<double>>();
    };
    const auto near = [](const std::vector<double>& a, const std::vector<double>& b) {
        double d = 0;
        for (std::size_t i = 0; i < a.size(); ++i) d = std::max(d, std::abs(a[i] - b[i]));
        return a.size() == b.size() && d < 1e-14;
    };
    const auto expected = at(kSurface, "0.3,0.7");
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {"--elevate", "2"},
             {"--elevate", "1", "--axis", "u"},
             {"--insert-knots", "0.5,0.25"},
             {"--insert-knots", "0.5,0.5", "--axis", "v"},
             {"--insert-knots", "0.4", "--elevate", "1", "--reduce", "1e-9"}}) {
        std::vector<std::string> arguments{"convert", "-"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Ran r = run(arguments, kSurface);
        ASSERT_EQ(r.code, 0) << r.err;
        EXPECT_TRUE(near(at(r.out, "0.3,0.7"), expected)) << r.out;
    }
    const Ran reversed = run({"convert", "-", "--reverse", "--axis", "v"}, kSurface);
    EXPECT_TRUE(near(at(reversed.out, "0.3,0.3"), expected)) << reversed.out;
    const Ran pieces = run({"convert", "-", "--insert-knots", "0.5", "--to-bezier"}, kSurface);
    const Json objects = Json::parse(pieces.out)["objects"];
    ASSERT_EQ(objects.size(), 2u);
    EXPECT_EQ(objects[0]["knots"][0], Json::parse("[0,0,0.5,0.5]"));
    EXPECT_TRUE(near(at(Json(objects[0]).dump(), "0.3,0.7"), expected));
    const Json halves =
        Json::parse(run({"convert", "-", "--split", "0.5", "--axis", "v"}, kSurface).out)["objects"];
    ASSERT_EQ(halves.size(), 2u);
    EXPECT_TRUE(near(at(Json(halves[1]).dump(), "0.3,0.7"), expected));
}

TEST_F(Cli, convert_removes_knots_within_a_bound_and_says_it) {
    const Ran fine = run({"convert", "-", "--insert-knots", "0.25,0.5,0.75", "-o", "fine.json"}, kCurve);
    ASSERT_EQ(fine.code, 0) << fine.err;
    const Ran r = run({"convert", "fine.json", "--reduce", "1e-6", "-o", "thin.json", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json report = Json::parse(r.out);
    EXPECT_EQ(report["removed_knots"], 3);
    EXPECT_LE(report["bound"].get<double>(), 1e-6);
    EXPECT_EQ(Json::parse(content(path("thin.json")))["objects"][0]["points"].size(), 4u);
}

TEST_F(Cli, convert_refuses_changes_that_do_not_exist) {
    expect_error(run({"convert", "-", "--split", "2", "--json"}, kCurve), 1, "out_of_domain", "--split",
                 "[0, 1]");
    expect_error(run({"convert", "-", "--insert-knots", "2", "--json"}, kCurve), 1, "out_of_domain",
                 "standard input: objects[0] \"c1\": --insert-knots", "");
    expect_error(run({"convert", "-", "--elevate", "25", "--json"}, kCurve), 1, "no_answer", "--elevate",
                 "25");
    expect_error(run({"convert", "-", "--reverse", "--axis", "v", "--json"}, kCurve), 1, "no_answer",
                 "--axis", "no v");
    expect_error(run({"convert", "-", "--to", "xyz", "--json"}, kCurve), 2, "usage", "", ".bpt");
}

TEST_F(Cli, wrong_usage_is_told_from_wrong_files) {
    struct Case {
        std::vector<std::string> arguments;
        std::string message;
    };
    for (const Case& c :
         std::vector<Case>{{{}, "which command"},
                           {{"inof", "x"}, "did you mean \"info\"?"},
                           {{"info"}, "FILE is required"},
                           {{"info", "-", "--jason"}, "did you mean \"--json\"?"},
                           {{"eval", "-"}, "--at is required"},
                           {{"eval", "-", "--at", "x"}, "found \"x\""},
                           {{"eval", "-", "--at", "nan"}, "found \"nan\""},
                           {{"eval", "-", "--at", "0", "--derivatives", "-1"}, "from 0 to"},
                           {{"convert", "-", "--elevate", "1.5"}, "whole number"},
                           {{"convert", "-", "--axis", "x"}, "x not in {u,v,w}"},
                           {{"convert", "-", "--split", "left"}, "needs a number"},
                           {{"convert", "-", "--insert-knots", "0,,1"}, "commas, found"},
                           {{"convert", "-", "--split"}, "1 required NUMBER missing"},
                           {{"convert", "-", "-", "-"}, "(freiform convert --help)"},
                           {{"tessellate", "-", "--max-triangles", "-1"}, "whole number"},
                           {{"info", "-", "--timeout", "0"}, "positive number"},
                           {{"info", "-", "--max-memory", "x"}, "number of bytes"},
                           {{"tessellate", "-", "--tolerance", "0"}, "positive"},
                           {{"tessellate", "-", "--tolerance", "1", "--angle", "-1"}, "\"-1\""},
                           {{"tessellate", "-", "--aspect", "1"}, "above 1"},
                           {{"draw", "-", "-o", "d.png", "--tolerance", "0"}, "positive"},
                           {{"section", "-", "--plane", "0,0,1,0", "--tolerance", "-1"}, "positive"},
                           {{"revolve", "-", "--axis", "0,0,0,1,0,0", "--polynomial", "0"}, "positive"},
                           {{"quadric", "sphere", "--radius", "-2"}, "positive"},
                           {{"conic", "--circle", "0,0,0"}, "radius above 0"},
                           {{"extrude", "-", "--by", "0,0,0"}, "not 0"},
                           {{"section", "-", "--plane", "0,0,0,1"}, "not 0"},
                           {{"section", "-", "--plane", "1,1,1,0,0,0"}, "not 0"},
                           {{"features", "-", "--line", "0,0,1"}, "not 0"},
                           {{"features", "-", "--plane", "0,0,0,1"}, "not 0"},
                           {{"revolve", "-", "--axis", "1,1,1,0,0,0"}, "not 0"},
                           {{"revolve", "-", "--axis", "0,0,0,1,0,0", "--angle", "0"}, "found 0"},
                           {{"quadric", "sphere", "--radius", "2", "--axis", "0,0,0"}, "axis: is zero"},
                           {{"quadric", "sphere", "--radius", "2", "--angle", "400"}, "turn"},
                           {{"length", "-", "--range", "1,0"}, "smaller parameter first"},
                           {{"inside", "-", "--points", "-", "--tolerance", "-1"}, "negative"}}) {
        const Ran r = run(c.arguments, kCurve);
        EXPECT_EQ(r.code, 2) << r.err;
        EXPECT_EQ(r.out, "");
        EXPECT_TRUE(r.err.starts_with("freiform: ")) << r.err;
        EXPECT_NE(r.err.find(c.message), std::string::npos) << r.err;
    }
    expect_error(run({"inof", "--json"}), 2, "usage", "", "info");
}

TEST_F(Cli, nonsense_is_refused_by_every_reader_with_a_sentence) {
    std::mt19937 random(3);
    std::string noise(5000, ' ');
    for (char& c : noise) c = char(random());
    const std::string teapot = content(kTeapot);
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"empty.json", ""},
        {"empty.bpt", ""},
        {"empty", ""},
        {"noise.json", noise},
        {"noise.bpt", noise},
        {"noise", noise},
        {"cut.json", kCurve.substr(0, kCurve.size() / 2)},
        {"cut.bpt", teapot.substr(0, teapot.size() / 2)},
        {"nan.json", R"({"type":"curve","points":[[0,0],[NaN,1]]})"},
        {"nan.bpt", "1\n0 0\nnan 0 0\n"},
        {"huge.json", R"({"type":"curve","points":[[0,0],[1e308,1]]})"},
        {"huge.bpt", "1\n0 0\n1e308 0 0\n"},
        {"inf.json", R"({"type":"curve","points":[[0,0],[1e999,1]]})"},
        {"minus.bpt", "-1\n"},
        {"minus2.bpt", "1\n-3 3\n"},
        {"many.bpt", "2000000000\n3 3\n"},
        {"deep.json", std::string(100000, '[')},
        {"minus.json", R"({"type":"curve","degree":-3,"points":[[0,0],[1,1]]})"},
        {"zeros", std::string(3000, '\0')},
        {"word.txt", "hello"},
        {"null.json", "null"}};
    for (const auto& [name, bytes] : cases) {
        const std::string where = file(name, bytes);
        for (const std::string command : {"info", "convert"}) {
            const Ran r = run({command, where});
            EXPECT_EQ(r.code, 3) << name << ": " << r.err;
            EXPECT_EQ(r.out, "") << name;
            EXPECT_TRUE(r.err.starts_with("freiform: " + where)) << r.err;
            EXPECT_GT(r.err.size(), where.size() + 25) << r.err;
        }
    }
}

TEST_F(Cli, files_that_cannot_be_read_or_written_are_failures_of_their_own) {
    EXPECT_EQ(run({"info", "missing.json"}).code, 5);
    EXPECT_EQ(run({"info", "."}).code, 5);
    const Ran r = run({"convert", "-", "-o", "no/such/folder/x.json"}, kCurve);
    EXPECT_EQ(r.code, 5);
    EXPECT_NE(r.err.find("No such file"), std::string::npos) << r.err;
}

TEST_F(Cli, info_counts_what_a_solid_model_has) {
    FF_CORPUS_OR_SKIP(step, "step/xr1-tu-rod.stp");
    const Ran r = run({"info", step.string(), "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json model = Json::parse(r.out)["objects"][0];
    EXPECT_EQ(model["type"], "model");
    EXPECT_EQ(model["solids"], 1);
    EXPECT_EQ(model["faces"], 4);
    EXPECT_EQ(model["edges"], 6);
    EXPECT_EQ(model["open_edges"], 0);
    EXPECT_EQ(model["face_kinds"], Json::parse(R"({"nurbs": 2, "plane": 2})"));
    const Json same = Json::parse(run({"info", "-", "--json"}, content(step)).out)["objects"][0];
    EXPECT_EQ(same, model);
    // As a document it is the same model.
    ASSERT_EQ(run({"convert", step.string(), "-o", "m.json"}).code, 0);
    ASSERT_EQ(run({"convert", "m.json", "-o", "n.json"}).code, 0);
    EXPECT_EQ(content(path("m.json")), content(path("n.json")));
    EXPECT_EQ(Json::parse(run({"info", "m.json", "--json"}).out)["objects"][0], model);
    expect_error(run({"info", file("x.step", "garbage"), "--json"}), 3, "unreadable", "x.step: byte 0",
                 "ISO-10303-21");
}

TEST_F(Cli, limits_end_it_with_4_and_leave_no_file) {
    std::string large = R"({"type": "surface", "degrees": [3,3], "points": [)";
    const std::string knots = [] {
        std::string k = "[0,0,0,0";
        for (int i = 1; i < 697; ++i) k += "," + std::to_string(i);
        return k + ",697,697,697,697]";
    }();
    for (int i = 0; i < 700; ++i) {
        large += i ? ",[" : "[";
        for (int k = 0; k < 700; ++k)
            large += (k ? ",[" : "[") + std::to_string(i) + "," + std::to_string(k) + ",0.123456789]";
        large += "]";
    }
    file("large.json", large + "], \"knots\": [" + knots + "," + knots + "]}");
    expect_error(
        run({"convert", "large.json", "--elevate", "3", "-o", "x.json", "--timeout", "0.05", "--json"}), 4,
        "limit", "--timeout", "0.05");
    if (!kAddressSanitizer) {  // which takes more by itself
        expect_error(run({"convert", "large.json", "-o", "x.json", "--max-memory", "40M", "--json"}), 4,
                     "limit", "--max-memory", "41943040");
        expect_error(run({"info", "large.json", "--max-memory", "1M", "--json"}), 4, "limit", "large.json",
                     "bytes");
    }
    EXPECT_FALSE(std::filesystem::exists(path("x.json")));
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        EXPECT_FALSE(entry.path().filename().string().starts_with(".freiform")) << entry.path();
}

TEST_F(Cli, signals_end_it_with_their_code) {
    ASSERT_EQ(::mkfifo(path("pipe.json").c_str(), 0600), 0);
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t child = start({"info", "pipe.json"}, "", path(".out"));
        const int writer = ::open(path("pipe.json").c_str(), O_WRONLY);  // waits until the program reads
        ASSERT_GE(writer, 0);
        ::kill(child, signal);
        EXPECT_EQ(wait(child), 128 + signal);
        ::close(writer);
    }
}

TEST_F(Cli, a_closed_pipe_is_quiet) {
    const std::string command =
        std::string(FREIFORM_BINARY) + " convert " + kTeapot + " 2> " + path("err") + " | true";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(content(path("err")), "");
}

TEST_F(Cli, a_file_of_parameters_has_parameters) {
    for (const char* bytes : {"u\n", "[[0.5], [0.75]]", "{}"})
        EXPECT_EQ(run({"eval", "-", "--at", "@" + file("at.csv", bytes)}, kCurve).code, 3) << bytes;
}

TEST_F(Cli, help_says_which_values_an_option_takes) {
    const std::string help = run({"convert", "--help"}).out;
    for (const char* part :
         {"FILE TEXT REQUIRED", "--json ", "-o,--output FILE", "--to FORMAT", "--object NAME|INDEX",
          "--to-bezier ", "--elevate N", "--insert-knots NUMBER,...", "--split NUMBER", "--axis TEXT:{u,v,w}",
          "--timeout SECONDS", "--max-memory BYTES",
          "Examples:\n  freiform convert teapot.bpt -o teapot.json"})
        EXPECT_NE(help.find(part), std::string::npos) << part << " is not in\n" << help;
    EXPECT_NE(run({"tessellate", "--help"}).out.find("--max-triangles N"), std::string::npos);
    EXPECT_NE(run({"--help"}).out.find("Exit codes: 0 done"), std::string::npos);
}

TEST_F(Cli, help_and_version_go_to_standard_output) {
    for (const std::vector<std::string>& a :
         std::vector<std::vector<std::string>>{{"--help"},
                                               {"info", "--help"},
                                               {"eval", "--help"},
                                               {"convert", "--help"},
                                               {"--version"},
                                               {"--version", "--verbose"}}) {
        const Ran r = run(a);
        EXPECT_EQ(r.code, 0);
        EXPECT_EQ(r.err, "");
        EXPECT_GT(r.out.size(), 10u);
    }
    EXPECT_NE(run({"eval", "--help"}).out.find("Usage: freiform eval "), std::string::npos);
    EXPECT_NE(run({"eval", "--help"}).out.find("freiform eval curve.json --at 0.5"), std::string::npos);
    EXPECT_NE(run({"--version", "--verbose"}).out.find("compiler"), std::string::npos);
}

}  // namespace
}  // namespace freiform::test
