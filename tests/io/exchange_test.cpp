#include <freiform/io/exchange.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <numbers>
#include <random>
#include <set>
#include <support/corpus.hpp>
#include <support/sanitizer.hpp>
#include <support/solids.hpp>
#include <unistd.h>

namespace {

using namespace freiform;
namespace fs = std::filesystem;

// Sets the environment variable for the time of its life.
class Variable {
public:
    Variable(const char* name, const std::string& value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        ::setenv(name, value.c_str(), 1);
    }
    ~Variable() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }

private:
    const char* name_;
    std::optional<std::string> old_;
};

class Exchange : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / text("freiform-exchange-", ::getpid());
        fs::create_directories(folder_);
        if (!fs::exists(FREIFORM_OCCT_BINARY)) GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
        reader_.emplace("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string file(const std::string& name, std::string_view bytes) const {
        const fs::path path = folder_ / name;
        std::ofstream(path, std::ios::binary) << bytes;
        return path.string();
    }
    // A shell script in the place of the reader.
    std::string script(std::string_view body) const {
        const std::string path = file("reader", text("#!/bin/sh\n", body, "\n"));
        fs::permissions(path, fs::perms::owner_all);
        return path;
    }
    fs::path folder_;
    std::optional<Variable> reader_;
};

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Every edge lies, within its tolerance, on every face that it bounds; loops are closed.
void expect_consistent(const Model& m, double joint) {
    for (std::size_t i = 0; i < m.faces.size(); ++i)
        for (const Loop& l : m.faces[i].loops) {
            const Coedge* last = &l.coedges.back();
            for (const Coedge& c : l.coedges) {
                const Edge& e = m.edges[std::size_t(c.edge)];
                const Edge& before = m.edges[std::size_t(last->edge)];
                EXPECT_EQ(last->reversed ? before.start : before.end, c.reversed ? e.end : e.start) << i;
                const auto end_of = [&](const Coedge& x, const Edge& edge, bool at_end) {
                    const Vec<2> uv =
                        jet<0>(x.curve, at_end != x.reversed ? edge.range.hi : edge.range.lo).value();
                    return jet<0>(m.faces[i].surface, uv.c).value();
                };
                EXPECT_LE(norm(end_of(*last, before, true) - end_of(c, e, false)), joint) << "face " << i;
                if (e.curve)
                    for (int k = 0; k <= 10; ++k) {
                        const double t = e.range.lo + e.range.length() * k / 10;
                        const Vec<3> p = jet<0>(m.faces[i].surface, jet<0>(c.curve, t).value().c).value();
                        EXPECT_LE(norm(p - jet<0>(*e.curve, t).value()), e.tolerance * (1 + 1e-9) + 1e-12)
                            << "face " << i << " edge " << c.edge;
                    }
                last = &c;
            }
        }
}

struct Expected {
    const char *name, *unit;
    int solids, faces, edges, open_edges;
};

class ReadsFile : public ::testing::TestWithParam<Expected> {};

TEST_P(ReadsFile, with_the_counts_that_it_is_known_to_have) {
    if (!fs::exists(FREIFORM_OCCT_BINARY)) GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
    const Expected& x = GetParam();
    FF_CORPUS_OR_SKIP(path, x.name);
    const Variable reader("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY);
    const auto model = read_with_occt(path.string());
    ASSERT_TRUE(model.has_value()) << model.error().where << ": " << model.error().message;
    const ModelSummary s = summary(*model);
    EXPECT_EQ(model->unit, x.unit);
    EXPECT_EQ(s.solids, x.solids);
    EXPECT_EQ(s.faces, x.faces);
    EXPECT_EQ(s.edges, x.edges);
    EXPECT_EQ(s.open_edges, x.open_edges);
    EXPECT_TRUE(model->refused.empty()) << model->refused.front().message;
    expect_consistent(*model, 1e-4 * s.box.diagonal());
}

INSTANTIATE_TEST_SUITE_P(Exchange, ReadsFile,
                         ::testing::Values(Expected{"step/linkrods.step", "mm", 1, 37, 108, 0},
                                           Expected{"step/screw.step", "mm", 1, 10, 22, 0},
                                           Expected{"step/as1-oc-214.stp", "mm", 18, 160, 354, 0},
                                           Expected{"step/cube-in.step", "inch", 1, 6, 12, 0},
                                           Expected{"step/cube-mm.step", "mm", 1, 6, 12, 0},
                                           Expected{"step/io1-cm-214.stp", "mm", 1, 29, 70, 0},
                                           Expected{"step/trj10_ch1-id-chs.stp", "inch", 1, 12, 28, 0},
                                           Expected{"step/conical-surface.step", "inch", 1, 5, 8, 0},
                                           Expected{"brep/Ball.brep", "", 2, 17, 43, 0},
                                           Expected{"brep/CrankArm.brep", "", 2, 53, 138, 0},
                                           Expected{"iges/bearing.iges", "mm", 0, 213, 941, 925},
                                           Expected{"iges/bug22869_Spring.igs", "mm", 1, 6, 11, 0}),
                         [](const auto& parameter) {
                             std::string name = parameter.param.name;
                             for (char& c : name)
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             return name;
                         });

// A patch of a cylinder, cut out by a loop that has it on its right.
TEST_F(Exchange, tells_of_loops_that_run_the_wrong_way) {
    if (!fs::exists(FREIFORM_OCCT_BINARY)) GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
    const Variable reader("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY);
    const auto model = read_with_occt(FREIFORM_SOURCE_DIR "/tests/data/brep/turned_loop.brep");
    ASSERT_TRUE(model.has_value()) << model.error().message;
    EXPECT_EQ(model->faces.size(), 1u);
    ASSERT_FALSE(model->approximations.empty());
    EXPECT_EQ(model->approximations[0].where, "face 0");
    EXPECT_NE(model->approximations[0].what.find("run the wrong way"), std::string::npos);
}

// Half a ball, whose boundary has no degenerate edge where its seam ends at the pole.
TEST_F(Exchange, adds_the_degenerate_edges_that_loops_lack) {
    if (!fs::exists(FREIFORM_OCCT_BINARY)) GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
    const Variable reader("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY);
    const auto model = read_with_occt(FREIFORM_SOURCE_DIR "/tests/data/brep/pole_without_an_edge.brep");
    ASSERT_TRUE(model.has_value()) << model.error().message;
    EXPECT_EQ(std::ranges::count_if(model->edges, &Edge::degenerate), 1);
    EXPECT_TRUE(model->approximations.empty());
    const double tolerance = 0.01;
    const Tessellation made = test::closed_tessellation(*model, tolerance);
    EXPECT_NEAR(test::signed_volume(made.mesh), 16 * std::numbers::pi / 3, 12 * std::numbers::pi * tolerance);
}

TEST_F(Exchange, leaves_coordinates_in_the_unit_of_the_file) {
    FF_CORPUS_OR_SKIP(inches, "step/cube-in.step");
    FF_CORPUS_OR_SKIP(millimetres, "step/cube-mm.step");
    const auto a = read_with_occt(inches.string()), b = read_with_occt(millimetres.string());
    ASSERT_TRUE(a && b);
    Box<3> small, large;
    for (const Vertex& v : a->vertices) small.add(v.point);
    for (const Vertex& v : b->vertices) large.add(v.point);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(small.hi[i] - small.lo[i], 1000 / 25.4, 1e-9);
        EXPECT_NEAR(large.hi[i] - large.lo[i], 1000, 1e-9);
    }
}

// The largest distance of an edge from its image on the face, among many samples.
double dense_gap(const Model& m, const Face& f, const Coedge& c) {
    const Edge& e = m.edges[std::size_t(c.edge)];
    const auto on = limits(f.surface);
    double worst = 0;
    for (int k = 0; k <= 2000; ++k) {
        const double t = e.range.lo + e.range.length() * (k / 2000.0);
        const Vec<3> p = jet<0>(f.surface, clamped(jet<0>(c.curve, t).value(), on).c).value();
        if (e.curve) worst = std::max(worst, norm(p - jet<0>(*e.curve, t).value()));
    }
    return worst;
}

TEST_F(Exchange, lists_every_parameter_curve_that_it_replaces_with_a_proven_bound) {
    FF_CORPUS_OR_SKIP(path, "step/linkrods.step");
    const auto m = read_with_occt(path.string());
    ASSERT_TRUE(m.has_value());
    int replaced = 0, raised = 0;
    std::vector<double> listed(m->edges.size(), 0);
    for (const Approximation& a : m->approximations) {
        ASSERT_TRUE(a.bound.has_value()) << a.what;
        int edge = -1;
        ASSERT_EQ(std::sscanf(a.where.c_str(), "edges[%d]", &edge), 1) << a.where;
        ASSERT_LT(std::size_t(edge), m->edges.size());
        replaced += a.what.find("is replaced by a spline") != std::string::npos;
        raised += a.what.find("the file says at most") != std::string::npos;
        EXPECT_LE(*a.bound, std::max(m->edges[std::size_t(edge)].tolerance, 1e-6)) << a.where;
        listed[std::size_t(edge)] = std::max(listed[std::size_t(edge)], *a.bound);
    }
    EXPECT_GT(replaced, 40);
    EXPECT_GT(raised, 20);
    int refitted = 0;
    for (const Face& f : m->faces)
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) {
                const double gap = dense_gap(*m, f, c);
                EXPECT_LE(gap, m->edges[std::size_t(c.edge)].tolerance) << c.edge;
                // What the refit makes: cubic, all inner knots double.
                const auto* curve = std::get_if<Curve<Vec<2>>>(&c.curve);
                if (!curve || curve->basis().degree() != 3) continue;
                const auto breaks = curve->basis().breaks();
                if (breaks.size() < 9 || !std::all_of(breaks.begin() + 1, breaks.end() - 1, [&](double t) {
                        return curve->basis().multiplicity(t) == 2;
                    }))
                    continue;
                ++refitted;
                EXPECT_LE(gap, listed[std::size_t(c.edge)]) << c.edge;
            }
    EXPECT_GE(refitted, replaced);
}

TEST_F(Exchange, turns_normals_out_of_the_solid) {
    FF_CORPUS_OR_SKIP(path, "step/cube-mm.step");
    const auto m = read_with_occt(path.string());
    ASSERT_TRUE(m.has_value());
    Vec<3> centre{};
    for (const Vertex& v : m->vertices) centre += 1.0 / double(m->vertices.size()) * v.point;
    ASSERT_EQ(m->shells.size(), 1u);
    ASSERT_EQ(m->shells[0].faces.size(), 6u);
    for (const FaceUse& use : m->shells[0].faces) {
        const Face& f = m->faces[std::size_t(use.face)];
        const Coedge& c = f.loops[0].coedges[0];
        const Vec<2> uv = jet<0>(c.curve, m->edges[std::size_t(c.edge)].range.middle()).value();
        EXPECT_FALSE(use.reversed);
        const double side = f.reversed ? -1 : 1;
        EXPECT_GT(side * dot(normal(f.surface, uv.c), jet<0>(f.surface, uv.c).value() - centre), 499);
    }
}

TEST_F(Exchange, reads_the_solid_among_the_examples) {
    const auto m = read_with_occt(FREIFORM_SOURCE_DIR "/examples/bracket.step");
    ASSERT_TRUE(m.has_value()) << m.error().message;
    const ModelSummary s = summary(*m);
    EXPECT_EQ(m->unit, "mm");
    EXPECT_EQ(s.solids, 1);
    EXPECT_EQ(s.faces, 24);
    EXPECT_EQ(s.edges, 53);
    EXPECT_EQ(s.open_edges, 0);
    EXPECT_TRUE(m->refused.empty());
    expect_consistent(*m, 1e-5);
    // The file has no parameter curves; those that were made follow the edges.
    for (const Edge& e : m->edges) EXPECT_LT(e.tolerance, 2e-5) << e.tolerance;
}

// Parameters that are beyond a seam by rounding ask for no more of the surface.
TEST_F(Exchange, periodic_splines_are_read_over_one_period) {
    const auto m = read_with_occt(FREIFORM_SOURCE_DIR "/examples/bracket.step");
    ASSERT_TRUE(m.has_value()) << m.error().message;
    int rings = 0;
    for (const Face& f : m->faces) {
        if (f.loops.size() != 1 || f.loops[0].coedges.size() != 4) continue;
        std::set<int> edges;
        for (const Coedge& c : f.loops[0].coedges) edges.insert(c.edge);
        if (edges.size() == 4) continue;
        const auto within = [&](const auto& s) {
            if constexpr (requires { s.net(); }) {
                ++rings;
                // The two sides of the seam are apart by all of one axis.
                std::vector<Vec<2>> sides;
                for (const Coedge& c : f.loops[0].coedges)
                    if (std::ranges::count(f.loops[0].coedges, c.edge, &Coedge::edge) == 2)
                        sides.push_back(
                            jet<0>(c.curve, m->edges[std::size_t(c.edge)].range.middle()).value());
                ASSERT_EQ(sides.size(), 2u);
                const Vec<2> apart = sides[1] - sides[0];
                const int axis = std::abs(apart[1]) > std::abs(apart[0]);
                const double period = s.basis(axis).domain().length();
                EXPECT_NEAR(std::abs(apart[axis]), period, 1e-9 * period);
            }
        };
        std::visit(within, f.surface);
    }
    EXPECT_EQ(rings, 4);
}

TEST_F(Exchange, keeps_colours_and_names) {
    FF_CORPUS_OR_SKIP(path, "step/red_cube_blue_cylinder.step");
    const auto m = read_with_occt(path.string());
    ASSERT_TRUE(m.has_value());
    ASSERT_EQ(m->bodies.size(), 2u);
    for (const Body& b : m->bodies) EXPECT_FALSE(b.name.empty());
    int red = 0, blue = 0;
    for (const Body& b : m->bodies) {
        const auto colour_of = [&](const FaceUse& f) {
            const auto& own = m->faces[std::size_t(f.face)].colour;
            return own ? own : b.colour;
        };
        for (int s : b.shells)
            for (const FaceUse& f : m->shells[std::size_t(s)].faces) {
                const auto c = colour_of(f);
                ASSERT_TRUE(c.has_value());
                red += c->r > 2 * c->b, blue += c->b > 2 * c->r;
            }
    }
    EXPECT_EQ(red, 6);
    EXPECT_EQ(blue, 3);
}

TEST_F(Exchange, refuses_what_is_no_file_of_its_formats) {
    const auto kind = [](const std::string& path) {
        const auto m = read_with_occt(path);
        return m ? std::string("a model") : text(name_of(m.error().kind), ": ", m.error().message);
    };
    EXPECT_EQ(kind((folder_ / "missing.step").string()), "io: No such file or directory");
    EXPECT_EQ(kind(folder_.string()), "io: is not a regular file");
    EXPECT_EQ(kind(file("empty.step", "")), "unreadable: the file is empty");
    EXPECT_NE(kind(file("x.step", "solid cube\n")).find("begins with 'solid cube?'"), std::string::npos);
}

TEST_F(Exchange, reports_how_the_reader_ended) {
    const std::string step = file("x.step", "ISO-10303-21;");
    const auto refusal = [&](std::string_view body, ImportLimits limits = {}) {
        const Variable reader("FREIFORM_OCCT_IMPORT", script(body));
        const auto m = read_with_occt(step, limits);
        return m ? Refusal{RefusalKind::invalid, "", "a model"} : m.error();
    };
    const Refusal crash = refusal("kill -SEGV $$");
    EXPECT_EQ(crash.kind, RefusalKind::unreadable);
    EXPECT_EQ(crash.message, "the reader ended with signal SIGSEGV (11); the file is probably damaged");
    const auto start = std::chrono::steady_clock::now();
    const Refusal hang = refusal("sleep 1000 & sleep 1000", {0.5, std::size_t(1) << 30});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    EXPECT_EQ(hang.kind, RefusalKind::limit);
    EXPECT_NE(hang.message.find("0.5 seconds"), std::string::npos);
    const Refusal large = refusal("head -c 5000000 /dev/zero", {30, 4000000});
    EXPECT_EQ(large.kind, RefusalKind::limit) << large.message;
    EXPECT_EQ(refusal("printf 'noise\\nrefusal\\tno_answer\\there\\tnothing in it\\n' >&2; exit 3"),
              (Refusal{RefusalKind::no_answer, "here", "nothing in it"}));
    EXPECT_EQ(refusal("exit 7").message, "the reader ended with status 7");
    EXPECT_EQ(refusal("echo nonsense").kind, RefusalKind::unreadable);
    EXPECT_EQ(refusal("yes >&2", {0.5, std::size_t(1) << 30}).kind, RefusalKind::limit)
        << "a reader that never stops talking";
}

TEST_F(Exchange, says_what_to_install_where_the_reader_is_missing) {
    const std::string step = file("x.step", "ISO-10303-21;");
    const Variable reader("FREIFORM_OCCT_IMPORT", (folder_ / "nowhere").string());
    const auto m = read_with_occt(step);
    ASSERT_FALSE(m.has_value());
    EXPECT_EQ(m.error().kind, RefusalKind::unavailable);
    EXPECT_NE(m.error().message.find("libocct-data-exchange-dev"), std::string::npos);
}

TEST_F(Exchange, keeps_the_memory_limit) {
    if (test::kAddressSanitizer) GTEST_SKIP() << "AddressSanitizer needs more memory than the limits allow";
    FF_CORPUS_OR_SKIP(path, "step/linkrods.step");
    int models = 0;
    for (std::size_t mebibytes : {20, 60, 86, 120, 300}) {
        const auto m = read_with_occt(path.string(), {60, mebibytes << 20});
        if (m)
            ++models;
        else
            EXPECT_EQ(m.error().kind, RefusalKind::limit) << mebibytes << ": " << m.error().message;
        EXPECT_FALSE(m.has_value() && mebibytes == 20);
    }
    EXPECT_GT(models, 0);
}

// Damaged files: the answer is a model or a refusal that says something, and it comes soon.
void expect_an_answer(const std::string& path, const std::string& what) {
    const auto start = std::chrono::steady_clock::now();
    const auto m = read_with_occt(path, {20, std::size_t(2) << 30});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(25)) << what;
    if (m)
        EXPECT_TRUE(make_model(*m).has_value()) << what;
    else
        EXPECT_FALSE(m.error().message.empty()) << what;
}

TEST_F(Exchange, answers_to_truncated_files) {
    FF_CORPUS_OR_SKIP(path, "step/screw.step");
    const std::string bytes = bytes_of(path);
    for (std::size_t i = 0; i < 50; ++i)
        expect_an_answer(file("cut.step", bytes.substr(0, i * bytes.size() / 50)), text("cut ", i));
}

TEST_F(Exchange, answers_to_damaged_files) {
    FF_CORPUS_OR_SKIP(path, "step/cube-mm.step");
    const std::string bytes = bytes_of(path);
    const auto replaced = [&](std::string_view from, std::string_view to) {
        std::string s = bytes;
        std::size_t n = 0;
        for (std::size_t at = 0; (at = s.find(from, at)) != std::string::npos; at += to.size(), ++n)
            s.replace(at, from.size(), to);
        EXPECT_GT(n, 0u) << from;
        return s;
    };
    expect_an_answer(file("a.step", replaced("1.E+03", "1.E+308")), "huge numbers");
    expect_an_answer(file("b.step", replaced("1.E+03", "NAN")), "not a number");
    expect_an_answer(file("c.step", replaced("VERTEX_POINT('',#", "VERTEX_POINT('',#9")), "dangling");
    expect_an_answer(file("d.step", replaced("CARTESIAN_POINT('',(", "CARTESIAN_POINT('',($,")), "omitted");
    expect_an_answer(
        file("e.step",
             "ISO-10303-21;HEADER;FILE_DESCRIPTION((''),'1');FILE_NAME('','',(''),(''),'','','');"
             "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;DATA;#1=EDGE_CURVE('',#1,#1,#1,.T.);"
             "#2=MANIFOLD_SOLID_BREP('',#2);#3=EDGE_LOOP('',(#3));ENDSEC;END-ISO-10303-21;"),
        "cyclic");
    std::mt19937_64 random(7);
    for (int i = 0; i < 10; ++i) {
        std::string noisy = bytes;
        for (int k = 0; k < 30; ++k) noisy[200 + random() % (noisy.size() - 200)] = char(' ' + random() % 95);
        expect_an_answer(file("noise.step", noisy), text("noise ", i));
    }
}

TEST_F(Exchange, answers_to_damaged_brep_and_iges_files) {
    FF_CORPUS_OR_SKIP(brep, "brep/cube.brep");
    FF_CORPUS_OR_SKIP(iges, "iges/cube.iges");
    std::mt19937_64 random(11);
    for (const auto& path : {brep, iges}) {
        const std::string bytes = bytes_of(path);
        for (std::size_t i = 0; i < 10; ++i) {
            std::string noisy = bytes.substr(0, i % 2 == 0 ? (i + 1) * bytes.size() / 11 : bytes.size());
            for (int k = 0; k < 10 && noisy.size() > 200; ++k)
                noisy[100 + random() % (noisy.size() - 100)] = "0123456789-. "[random() % 13];
            expect_an_answer(file("noise", noisy), text(path.string(), " ", i));
        }
    }
}

}  // namespace
