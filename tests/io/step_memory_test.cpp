// How much memory a STEP file takes to be read and counted.
#include <freiform/io/read.hpp>
#include <freiform/io/step.hpp>
#include <freiform/model/swept_solid.hpp>

#include <filesystem>
#include <fstream>
#include <support/effort.hpp>
#include <support/random.hpp>
#include <support/solids.hpp>
#include <unistd.h>

namespace freiform::test {
namespace {

// Of a file's size, that `freiform info` takes beside what the process has.
constexpr double kMostOfSize = 40;

TEST(StepMemory, a_file_is_read_and_counted_in_a_multiple_of_its_size) {
    const auto file =
        (std::filesystem::temp_directory_path() / text("freiform-memory-", ::getpid(), ".step")).string();
    // In another process: memory that this one has given back would be used again, and not be seen.
    const Effort written = effort_of([&] {
        Document document{"mm", {}};
        for (int i = 0; i < 600; ++i) {
            const double x = 30.0 * i;
            document.objects.push_back(
                {"",
                 must(
                     prism(loops_of({{ellipse({{x, 5}}, 2, 2), ellipse({{x, 5.25}}, 1, 0.5)}}), {{0, 0, 2}})),
                 {}});
        }
        return bool(std::ofstream(file, std::ios::binary) << must(write_step(document)));
    });
    ASSERT_TRUE(written.ended);
    const double size = double(std::filesystem::file_size(file)) / (1 << 20);
    EXPECT_GT(size, 2) << "large enough that other memory does not matter";
    const Effort before = effort_of([] { return true; });
    const Effort info = effort_of([&] {
        const auto read = read_any(file);
        return read && summary(std::get<Model>(read->objects.at(0).shape)).solids == 600;
    });
    std::filesystem::remove(file);
    EXPECT_TRUE(info.ended);
    if (!kIsMeasured) return;
    const double ratio = (info.mebibytes - before.mebibytes) / size;
    EXPECT_LE(ratio, kMostOfSize);
    RecordProperty("times_the_size", std::to_string(ratio));
}

}  // namespace
}  // namespace freiform::test
