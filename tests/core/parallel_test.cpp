#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace freiform {
namespace {

// Leaves the process as it was found.
struct Threads {
    explicit Threads(int n) { set_max_threads(n); }
    ~Threads() { set_max_threads(0); }
};

TEST(ParallelFor, calls_every_index_once) {
    for (const int threads : {0, 1, 2, 3})
        for (const std::size_t n : {0, 1, 2, 99, 1000})
            for (const std::size_t grain : {0, 1, 10, 600}) {
                const Threads limit(threads);
                std::vector<std::atomic<int>> calls(n);
                parallel_for(n, grain, [&](std::size_t i) { ++calls[i]; });
                for (std::size_t i = 0; i < n; ++i)
                    ASSERT_EQ(calls[i], 1) << i << " of " << n << ", grain " << grain;
            }
}

TEST(ParallelFor, is_serial_and_in_order_below_twice_the_grain) {
    const auto here = std::this_thread::get_id();
    std::vector<std::size_t> order;
    parallel_for(19, 10, [&](std::size_t i) {
        // Time for another thread to take the second half, if it is offered.
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        ASSERT_EQ(std::this_thread::get_id(), here);
        order.push_back(i);
    });
    ASSERT_EQ(order.size(), 19u);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

TEST(ParallelFor, one_thread_is_the_calling_one) {
    const Threads limit(1);
    const auto here = std::this_thread::get_id();
    parallel_for(1000, 1, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), here); });
}

// Each call of the outer loop has a thread to itself until it is done, though it waits for an inner loop.
TEST(ParallelFor, a_loop_in_a_loop_has_its_threads_and_takes_up_nothing_else) {
    static thread_local int begun = 0;
    for (const int threads : {0, 1, 2}) {
        const Threads limit(threads);
        std::vector<std::atomic<int>> calls(40 * 200);
        std::atomic<int> at_once{0}, most_at_once{0}, nested{0};
        parallel_for(40, 1, [&](std::size_t i) {
            if (++begun > 1) ++nested;
            parallel_for(200, 1, [&](std::size_t k) {
                const int now = ++at_once;
                for (int m = most_at_once; m < now && !most_at_once.compare_exchange_weak(m, now);) continue;
                if (k % 50 == i) std::this_thread::sleep_for(std::chrono::microseconds(200));
                ++calls[200 * i + k];
                --at_once;
            });
            --begun;
        });
        for (std::size_t i = 0; i < calls.size(); ++i) ASSERT_EQ(calls[i], 1) << i;
        EXPECT_EQ(nested, 0) << threads;
        if (threads > 0) {
            EXPECT_LE(most_at_once, threads);
        }
    }
}

TEST(ParallelFor, gives_the_same_bits_for_any_number_of_threads) {
    const auto compute = [](int threads) {
        const Threads limit(threads);
        std::vector<double> out(5000);
        parallel_for(out.size(), 16, [&](std::size_t i) { out[i] = std::sin(double(i)) / 3; });
        return out;
    };
    EXPECT_EQ(compute(1), compute(2));
    EXPECT_EQ(compute(1), compute(0));
}

// It has none of the threads of the one it was forked off, and whatever these were at.
TEST(ParallelFor, forked_processes_go_on_alone) {
    const auto is_done = [] {
        std::vector<std::atomic<int>> calls(64);
        for (int round = 0; round < 20; ++round)
            parallel_for(calls.size(), 1, [&](std::size_t i) {
                parallel_for(4, 1, [&](std::size_t) { calls[i] += int(std::sqrt(double(i + 1))) > 0; });
            });
        return std::all_of(calls.begin(), calls.end(), [](const auto& c) { return c == 80; });
    };
    for (int k = 0; k < 300; ++k) {
        ASSERT_TRUE(is_done());
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            alarm(30);
            _exit(is_done() ? 0 : 1);
        }
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "after " << k;
    }
}

TEST(ParallelFor, a_negative_limit_means_no_limit) {
    const Threads limit(-5);
    EXPECT_EQ(max_threads(), 0);
}

}  // namespace
}  // namespace freiform
