// Real models with a tolerance that nobody can pay for: refused before any work, with the number that would
// be needed; and how far that number is from the truth where it can be counted. FREIFORM_CORPUS_MODELS=all
// takes all files of the corpus.
#include "support/corpus.hpp"

#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <gtest/gtest.h>
#include <support/sanitizer.hpp>

using namespace freiform;
using namespace freiform::test;

namespace {

#ifdef NDEBUG
constexpr double kAtOnce = 0.05;
#else
constexpr double kAtOnce = kAddressSanitizer ? 2 : 0.25;
#endif
constexpr double kPredictedWithin = 32;  // a factor, either way

std::vector<std::filesystem::path> models_to_try() {
    if (const char* said = std::getenv("FREIFORM_CORPUS_MODELS"); said && std::string_view(said) == "all") {
        std::vector<std::filesystem::path> out;
        for (const char* folder : {"bpt", "step", "iges", "brep"})
            if (const auto root = corpus(folder))
                for (const auto& f : std::filesystem::directory_iterator(*root)) out.push_back(f.path());
        std::sort(out.begin(), out.end());
        return out;
    }
    std::vector<std::filesystem::path> out;
    for (const char* name : {"bpt/teapot.bpt", "step/as1-oc-214.stp", "step/xr1-tu-rod.stp",
                             "iges/bug23591_VZ-387.igs", "brep/cube.brep", "brep/solid.brep"})
        if (const auto path = corpus(name)) out.push_back(*path);
    return out;
}

TEST(BudgetCorpus, hopeless_tolerances_are_refused_at_once_with_a_number_of_the_right_size) {
    if (std::filesystem::exists(FREIFORM_OCCT_BINARY))
        ::setenv("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY, 1);
    FF_CORPUS_OR_SKIP(first, "bpt/teapot.bpt");
    EXPECT_TRUE(std::filesystem::exists(first));
    int refused = 0, flat = 0, skipped = 0;
    std::vector<double> factors;
    double slowest = 0;
    for (const auto& path : models_to_try()) {
        const std::string name = path.filename().string();
        const auto document = read_any(path.string());
        const auto model = document ? scene_of(*document) : Result<Model>(std::unexpected(document.error()));
        if (!model) {  // curves, or a format that is not read
            std::printf("left out: %s: %s\n", name.c_str(), model.error().message.c_str());
            ++skipped;
            continue;
        }
        const double diagonal = summary(*model).box.diagonal();
        const TessellateOptions hopeless{.tolerance = 1e-9 * diagonal, .max_triangles = 1000};
        const std::clock_t start = std::clock();  // of the processor: others may be at work
        const auto t = tessellate(*model, hopeless);
        const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
        if (t) {  // planes between straight edges
            EXPECT_LE(t->mesh.triangles.size(), 1000u) << name;
            EXPECT_LE(t->error_bound, hopeless.tolerance) << name;
            ++flat;
        } else {
            EXPECT_EQ(t.error().kind, RefusalKind::limit) << name;
            EXPECT_EQ(t.error().where, "max_triangles") << name;
            // The number may be that of fewer samples, where these are far beyond the limit.
            double said = 0;
            EXPECT_EQ(std::sscanf(t.error().message.c_str(), "about %lf triangles", &said), 1)
                << name << ": " << t.error().message;
            const double predicted = predicted_triangles(*model, hopeless);
            EXPECT_LE(said, 4 * predicted) << name;
            EXPECT_GE(said, predicted / 4) << name;
            EXPECT_LT(seconds, kAtOnce) << name;
            slowest = std::max(slowest, seconds);
            ++refused;
        }
        const TessellateOptions usual{.tolerance = 1e-3 * diagonal};
        const auto made = tessellate(*model, usual);
        if (!made || !made->refused.empty()) continue;
        const double factor = predicted_triangles(*model, usual) / double(made->mesh.triangles.size());
        EXPECT_LE(factor, kPredictedWithin) << name;
        EXPECT_GE(factor, 1 / kPredictedWithin) << name;
        factors.push_back(factor);
    }
    EXPECT_GE(refused, 4);
    ASSERT_FALSE(factors.empty());
    std::sort(factors.begin(), factors.end());
    const double median = factors[factors.size() / 2];
    EXPECT_GE(median, 1.0 / 4);
    EXPECT_LE(median, 4);
    std::printf(
        "%d refused, the slowest after %.4f s; %d flat; %d left out; predicted / made: %.3f to %.3f, median "
        "%.3f of %zu\n",
        refused, slowest, flat, skipped, factors.front(), factors.back(), median, factors.size());
}

}  // namespace
