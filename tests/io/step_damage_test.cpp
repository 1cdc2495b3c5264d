// Damaged STEP files.
#include <freiform/io/file.hpp>
#include <freiform/io/step_read.hpp>

#include <cstdlib>
#include <ctime>
#include <support/effort.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/sanitizer.hpp>
#include <support/step_solids.hpp>

namespace freiform::test {
namespace {

// Bytes changed, lines moved and numbers replaced: a model or a refusal that says something, soon.
std::string mutant(const std::string& seed, Random& r) {
    constexpr std::string_view kPieces[] = {"#1",      "#999999", "$",  "*",   "1.E308", "-0.", "()",
                                            "(",       ")",       "'",  ";",   ".T.",    ".F.", "0",
                                            "1.E-300", ",",       "/*", "NAN", "\\X2\\"};
    std::string s = seed;
    for (int k = r.integer(1, 8); k > 0 && !s.empty(); --k) {
        const auto at = std::size_t(r.integer(0, int(s.size()) - 1));
        switch (r.integer(0, 5)) {
            case 0:
                s[at] = char(r.integer(0, 255));
                break;
            case 1:
                s.erase(at, std::size_t(r.integer(1, 40)));
                break;
            case 2:
                s.insert(at, kPieces[r.integer(0, int(std::size(kPieces)) - 1)]);
                break;
            case 3: {  // another number in place of a reference
                const std::size_t hash = s.find('#', at);
                if (hash != std::string::npos) s.replace(hash, 2, text("#", r.integer(1, 120)));
                break;
            }
            case 4: {  // a statement again, elsewhere
                const std::size_t begin = s.find('\n', at), end = s.find('\n', begin + 1);
                if (end != std::string::npos)
                    s.insert(s.find('\n', s.size() / 2) + 1, s.substr(begin + 1, end - begin));
                break;
            }
            default: {  // a digit
                const std::size_t digit = s.find_first_of("0123456789", at);
                if (digit != std::string::npos) s[digit] = char('0' + r.integer(0, 9));
            }
        }
    }
    return s;
}

constexpr int kOfAProcess = 1000;  // mutants

// Seconds of the processor: see effort.hpp about the least of some tries.
double seconds_to_read(const std::string& bytes) {
    double least = HUGE_VAL;
    for (int i = 0; i < kTries && least >= 1; ++i) {
        const std::clock_t begin = std::clock();
        (void)read_step(bytes, {.memory_bytes = 100 << 20});
        least = std::min(least, double(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return least;
}

// 10,000 of each of eleven files, each thousand in a process of its own that stays below 256 MiB; none takes
// more than a second.
TEST(StepDamage, mutants_are_models_or_refusals_at_once_and_in_little_memory) {
    std::vector<std::string> seeds{round_solid("CYLINDRICAL_SURFACE('',#23,2.)", 10, false),
                                   round_solid("CONICAL_SURFACE('',#23,2.,-45.)", 0, true),
                                   round_solid("SPHERICAL_SURFACE('',#23,2.)", 0, true)};
    for (const char* name :
         {"circular_sets", "composite", "curves", "parts", "profiles", "repositioned", "sets", "swept"})
        seeds.push_back(must(read_file(text(FREIFORM_SOURCE_DIR, "/tests/fuzz/seeds/step/", name, ".stp"),
                                       std::size_t(1) << 20)));
    const char* named = std::getenv("FREIFORM_STEP_MUTANTS");
    const int count = named != nullptr ? std::atoi(named) : cases(10'000);
    for (std::size_t k = 0; k < seeds.size(); ++k) {
        const bool is_model = read_step(seeds[k]).has_value();  // one has triangles alone
        Random r(5);
        for (int begin = 0; begin < count; begin += kOfAProcess) {
            std::vector<std::string> mutants;
            for (int i = begin; i < std::min(begin + kOfAProcess, count); ++i)
                mutants.push_back(mutant(seeds[k], r));
            const Effort effort = effort_of([&] {
                std::size_t models = 0;
                bool right = true;
                for (const std::string& bytes : mutants) {
                    const std::clock_t start = std::clock();
                    const auto m = read_step(bytes, {.memory_bytes = 100 << 20});
                    const bool slow = 2 * (std::clock() - start) >= CLOCKS_PER_SEC;
                    models += m.has_value();
                    right =
                        right && (m || !m.error().message.empty()) && (!slow || seconds_to_read(bytes) < 1);
                }
                return right && models < mutants.size() && (!is_model || models > mutants.size() / 10);
            });
            EXPECT_TRUE(effort.ended) << "file " << k << " from mutant " << begin;
            if (kIsMeasured) {
                EXPECT_LT(effort.mebibytes, 256) << "file " << k << " from mutant " << begin;
            }
        }
    }
}

}  // namespace
}  // namespace freiform::test
