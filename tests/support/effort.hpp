// What a call took, in a process of its own: hostile input must neither take much memory nor long.
#pragma once
#include <algorithm>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace freiform::test {

// Sanitizers have measures of their own, and a process of theirs takes long to copy: what goes wrong ends the
// test with their report.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsMeasured = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kIsMeasured = false;
#else
inline constexpr bool kIsMeasured = true;
#endif
#else
inline constexpr bool kIsMeasured = true;
#endif

struct Effort {
    bool ended = false;  // by itself, and what was asked held
    double mebibytes = 0, seconds = 0;
};

inline constexpr unsigned kMostSeconds = 60;

// `f` says whether the answer is right; what it prints is not kept. Seconds are those of the processor, also
// those after which it is ended, so that others on the machine do not matter.
template <class F>
Effort effort_of(F&& f) {
    if (!kIsMeasured) return {.ended = f()};
    const pid_t child = fork();
    if (child == 0) {
        const rlimit most{kMostSeconds, kMostSeconds};
        setrlimit(RLIMIT_CPU, &most);
        alarm(10 * kMostSeconds);  // what waits takes no time of the processor
        _exit(f() ? 0 : 1);
    }
    int status = 0;
    rusage used{};
    Effort e;
    if (child < 0 || wait4(child, &status, 0, &used) != child) return e;
    e.ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    e.mebibytes = double(used.ru_maxrss) / 1024;
    e.seconds = double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    return e;
}

// Under a hypervisor even seconds of the processor hold what its neighbours cost: a page that is touched
// first may take ten times as long for a moment. What needs a second by itself needs it every time.
inline constexpr int kTries = 3;

template <class F>
Effort least_effort_of(F&& f) {
    Effort least = effort_of(f);
    for (int i = 1; kIsMeasured && i < kTries && least.ended && least.seconds >= 1; ++i) {
        const Effort e = effort_of(f);
        least = {e.ended, std::max(least.mebibytes, e.mebibytes), std::min(least.seconds, e.seconds)};
    }
    return least;
}

// Within 256 MiB, what the process had before included, and a second.
#define FF_EXPECT_LITTLE_EFFORT(...)                                      \
    do {                                                                  \
        const auto effort = freiform::test::least_effort_of(__VA_ARGS__); \
        EXPECT_TRUE(effort.ended);                                        \
        if (!freiform::test::kIsMeasured) break;                          \
        EXPECT_LT(effort.mebibytes, 256);                                 \
        EXPECT_LT(effort.seconds, 1);                                     \
    } while (false)

}  // namespace freiform::test
