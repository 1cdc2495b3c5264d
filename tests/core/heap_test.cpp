// Programs that let their heap grow in large pages.
#include <freiform/core/heap.hpp>

#include <cstdint>
#include <cstdlib>
#include <gtest/gtest.h>
#include <support/sanitizer.hpp>

#if defined(__linux__) && defined(__GLIBC__)
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace freiform {
namespace {

// Whether the kernel was told to use large pages for the part of memory that has this place.
bool is_in_large_pages(const void* place) {
    const auto at = reinterpret_cast<std::uintptr_t>(place);
    std::ifstream maps("/proc/self/smaps");
    bool here = false;
    for (std::string line; std::getline(maps, line);) {
        char* end = nullptr;
        const auto from = std::strtoull(line.c_str(), &end, 16);
        if (end != line.c_str() && *end == '-') here = from <= at && at < std::strtoull(end + 1, nullptr, 16);
        if (here && line.starts_with("VmFlags:")) return line.find(" hg") != std::string::npos;
    }
    return false;
}

// In a process of its own, which lasts: 1 if an array is in large pages, else 0.
int after_asking(rlim_t addresses) {
    const pid_t child = ::fork();
    if (child == 0) {
        const struct rlimit limit { addresses, addresses };
        ::setrlimit(RLIMIT_DATA, &limit);
        use_large_pages();
        const std::string array(std::size_t(1) << 24, 'x');
        ::_exit(is_in_large_pages(array.data() + array.size() / 2) ? 1 : 0);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Heap, arrays_are_in_large_pages_where_a_program_asks_for_them) {
    if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"))
        GTEST_SKIP() << "this system has no large pages";
    if (test::kAddressSanitizer) GTEST_SKIP() << "the sanitizer has an allocator of its own";
    EXPECT_EQ(after_asking(RLIM_INFINITY), 1);
    EXPECT_EQ(after_asking(rlim_t(4) << 30), 1);
}

TEST(Heap, stays_as_it_is_where_addresses_are_few) {
    if (test::kAddressSanitizer) GTEST_SKIP() << "the sanitizer takes terabytes of addresses";
    EXPECT_EQ(after_asking(rlim_t(1) << 30), 0);
}

}  // namespace
}  // namespace freiform
#endif
