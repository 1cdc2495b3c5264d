// A bar on standard error that tells how far a long command is; silent where nobody looks.
#pragma once
#include <freiform/core/text.hpp>

#include <string>

#if !defined(__wasm__)
#include <chrono>
#include <mutex>
#include <unistd.h>
#endif

namespace freiform::cli {

#if defined(__wasm__)

class Progress {
public:
    explicit Progress(std::string) {}
    void operator()(double) {}
};

#else

class Progress {
public:
    explicit Progress(std::string what) : what_(std::move(what)), shown_(::isatty(STDERR_FILENO) != 0) {}
    ~Progress() {
        if (drawn_) put("\r\x1b[K");
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // `part` of the work is done, 0 to 1. From any thread; draws at most ten times a second.
    void operator()(double part) {
        if (!shown_) return;
        const std::lock_guard lock(mutex_);
        const auto now = std::chrono::steady_clock::now();
        if (now - last_ < std::chrono::milliseconds(100)) return;
        last_ = now;
        constexpr int kWidth = 30;
        const int full = part <= 0 ? 0 : part >= 1 ? kWidth : int(part * kWidth);
        put(text("\r\x1b[K", what_, " [", std::string(std::size_t(full), '#'),
                 std::string(std::size_t(kWidth - full), ' '), "] ", full * 100 / kWidth, "%"));
        drawn_ = true;
    }

private:
    static void put(const std::string& s) { (void)!::write(STDERR_FILENO, s.data(), s.size()); }
    std::string what_;
    bool shown_, drawn_ = false;
    std::mutex mutex_;
    std::chrono::steady_clock::time_point last_{};
};

#endif

}  // namespace freiform::cli
