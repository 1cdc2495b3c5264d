// Loose faces of real IGES files: what sewing makes of them, and that what stays open is named with a reason.
#include "support/corpus.hpp"

#include <freiform/io/exchange.hpp>
#include <freiform/model/sew.hpp>

#include <filesystem>
#include <gtest/gtest.h>
#include <numeric>

using namespace freiform;
using namespace freiform::test;

namespace {

struct Loose {
    const char* name;
    int open_before, remaining;
    std::vector<int> rims;  // edges round each opening
};

class SewCorpus : public ::testing::TestWithParam<Loose> {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(FREIFORM_OCCT_BINARY))
            GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
        ::setenv("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY, 1);
    }
};

TEST_P(SewCorpus, edges_become_one_within_the_tolerance_of_the_file_and_the_rest_has_reasons) {
    FF_CORPUS_OR_SKIP(path, GetParam().name);
    const auto model = read_with_occt(path.string(), {});
    ASSERT_TRUE(model) << model.error().message;
    const double tolerance = largest_tolerance(*model);
    const auto sewn = sew(*model, {.tolerance = tolerance});
    ASSERT_TRUE(sewn) << sewn.error().message;
    EXPECT_EQ(sewn->open_before, GetParam().open_before);
    EXPECT_EQ(int(sewn->remaining.size()), GetParam().remaining);
    EXPECT_EQ(summary(sewn->model).open_edges, GetParam().remaining);
    EXPECT_EQ(sewn->model.faces.size(), model->faces.size());
    EXPECT_TRUE(sewn->twisted.empty());
    for (const SewnEdge& e : sewn->joined) {
        EXPECT_GE(e.faces.size(), 2u) << e.edge;
        EXPECT_LE(e.bound, tolerance) << e.edge;
    }
    for (const RemainingGap& r : sewn->remaining) {
        EXPECT_FALSE(r.reason.message.empty()) << r.edge;
        EXPECT_GE(r.face, 0) << r.edge;
        EXPECT_GE(r.gap, 0) << r.edge;
    }
    std::vector<int> rims;
    for (const Opening& o : sewn->openings) rims.push_back(int(o.edges.size()));
    EXPECT_EQ(rims, GetParam().rims);
    int on_rims = 0;
    for (const RemainingGap& r : sewn->remaining) on_rims += r.opening >= 0;
    EXPECT_EQ(on_rims, std::accumulate(rims.begin(), rims.end(), 0));
}

// Of the wing the two halves meet in the leading edge only: its tips have no faces, and its trailing edge is
// 0.0042 thick. The bearing is open below.
INSTANTIATE_TEST_SUITE_P(Iges, SewCorpus,
                         ::testing::Values(Loose{"iges/cube.iges", 24, 0, {}},
                                           Loose{"iges/wing128.igs", 8, 6, {6}},
                                           Loose{"iges/bearing.iges", 925, 25, {25}}),
                         [](const auto& of) {
                             std::string name = std::filesystem::path(of.param.name).stem().string();
                             return name;
                         });

}  // namespace
