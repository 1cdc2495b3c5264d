// Loops over independent items, on several threads where the build has oneTBB. What is computed never depends
// on the number of threads: every item writes to its own place.
#pragma once
#include <cstddef>
#include <functional>

namespace freiform {

// Calls f(i) once for every i in [0, n), possibly at the same time; f may have such loops itself. Serial if n
// < 2 * grain or max_threads == 1, and in a process that was forked off one that has used threads.
#ifdef FREIFORM_SERIAL  // a build without threads: nothing but the loop
template <class F>
void parallel_for(std::size_t n, std::size_t, const F& f) {
    for (std::size_t i = 0; i < n; ++i) f(i);
}
#else
void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t)>& f);
#endif

// 0: as many as the machine has (default). Applies to the whole process.
void set_max_threads(int threads);
int max_threads();

}  // namespace freiform
