#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <utility>
#ifndef FREIFORM_SERIAL
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <pthread.h>
#endif

namespace freiform {

namespace {
std::atomic<int> g_max_threads{0};
#ifndef FREIFORM_SERIAL
thread_local bool t_is_inside = false;  // of a loop

// A process that was forked off one with threads has none of them, though what is theirs says that they are
// there: whoever waits for them waits forever. It does without.
std::atomic<bool> g_has_lost_threads{false};

void watch_forks() {
    [[maybe_unused]] static const int once =
        pthread_atfork(nullptr, nullptr, [] { g_has_lost_threads = true; });
}
#endif
}  // namespace

void set_max_threads(int threads) { g_max_threads = std::max(threads, 0); }
int max_threads() { return g_max_threads; }

#ifndef FREIFORM_SERIAL
void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t)>& f) {
    grain = std::max<std::size_t>(grain, 1);
    if (const int threads = g_max_threads; n >= 2 * grain && threads != 1 && !g_has_lost_threads) {
        watch_forks();
        const auto loop = [&] {
            oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, n, grain),
                                      [&](const auto& range) {
                                          const bool before = std::exchange(t_is_inside, true);
                                          for (std::size_t i = range.begin(); i != range.end(); ++i) f(i);
                                          t_is_inside = before;
                                      });
        };
        // A loop in a loop has the threads of that one; who waits for it takes up nothing else.
        if (t_is_inside) {
            oneapi::tbb::this_task_arena::isolate(loop);
            return;
        }
        // More threads than the machine has would only make TBB print a warning.
        oneapi::tbb::task_arena arena(threads > 0
                                          ? std::min(threads, oneapi::tbb::info::default_concurrency())
                                          : oneapi::tbb::task_arena::automatic);
        arena.execute(loop);
        return;
    }
    for (std::size_t i = 0; i < n; ++i) f(i);
}
#endif

}  // namespace freiform
