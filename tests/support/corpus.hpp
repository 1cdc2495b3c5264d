// The corpus of real files: beside the repository, or where FREIFORM_CORPUS says. It is not part of the
// repository, so every test that wants it says what it misses and skips.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

namespace freiform::test {

// The root folder of the corpus, which need not exist.
inline std::filesystem::path corpus_root() {
    const char* named = std::getenv("FREIFORM_CORPUS");
    return named != nullptr && *named != '\0' ? std::filesystem::path(named)
                                              : std::filesystem::path(FREIFORM_SOURCE_DIR) / "../shared/data";
}

// A file or folder of the corpus by its name below the root: corpus("step/screw.step").
inline std::optional<std::filesystem::path> corpus(std::string_view name) {
    const auto path = corpus_root() / name;
    std::error_code none;
    if (!std::filesystem::exists(path, none)) return std::nullopt;
    return std::filesystem::weakly_canonical(path);
}

}  // namespace freiform::test

// Declares `variable`, the path of a file of the corpus, or skips the test and says why. For the body of a
// TEST.
#define FF_CORPUS_OR_SKIP(variable, name)                                           \
    const auto variable##_found_ = ::freiform::test::corpus(name);                  \
    if (!variable##_found_)                                                         \
        GTEST_SKIP() << "no " << (name) << " below "                                \
                     << ::freiform::test::corpus_root().lexically_normal().string() \
                     << " (FREIFORM_CORPUS names another folder)";                  \
    const std::filesystem::path& variable = *variable##_found_
