// Threads share the edges of a loop: what is read does not depend on their number.
#include "io/step_chart.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/step_read.hpp>

#include <atomic>
#include <filesystem>
#include <gtest/gtest.h>
#include <support/corpus.hpp>
#include <support/random.hpp>

namespace freiform::test {
namespace {

std::string read_by(int threads, const std::string& bytes) {
    set_max_threads(threads);
    const auto model = read_step(bytes, {.repair = true});
    set_max_threads(0);
    if (!model) return text(name_of(model.error().kind), ": ", model.error().message);
    Document d;
    d.objects.push_back({.name = "it", .shape = *model});
    return write_document(d);
}

void expect_the_same(const std::filesystem::path& file) {
    SCOPED_TRACE(file.string());
    const auto bytes = must(read_file(file.string(), 1 << 24));
    const std::string alone = read_by(1, bytes);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(read_by(0, bytes), alone);
}

TEST(StepThreads, small_files_are_read_the_same_by_any_number) {
    int files = 0;
    for (const auto& f : std::filesystem::directory_iterator(FREIFORM_SOURCE_DIR "/tests/data/step"))
        expect_the_same(f.path()), ++files;
    EXPECT_GT(files, 10);
}

TEST(StepThreads, splines_of_a_real_model_are_read_the_same_by_any_number) {
    FF_CORPUS_OR_SKIP(file, "step/linkrods.step");
    expect_the_same(file);
}

TEST(Once, one_of_those_that_threads_make_is_kept) {
    const step::Once<int> once;
    std::atomic<int> made = 0;
    std::vector<const int*> seen(64);
    parallel_for(seen.size(), 1,
                 [&](std::size_t i) { seen[i] = &once.get([&] { return std::make_unique<int>(++made); }); });
    for (const int* p : seen) EXPECT_EQ(p, seen[0]);
    EXPECT_GE(made, 1);
    const step::Once<int> copy = once;
    EXPECT_NE(&copy.get([] { return std::make_unique<int>(-1); }), seen[0]);
    EXPECT_EQ(copy.get([] { return std::make_unique<int>(-2); }), -1);
}

}  // namespace
}  // namespace freiform::test
