// Whether there is one thread: work that is only for several is left out then, and its code where there never
// are.
#pragma once
#include <freiform/core/parallel.hpp>

namespace freiform {

#ifdef FREIFORM_THREADS
inline bool is_serial() { return max_threads() == 1; }
#else
constexpr bool is_serial() { return true; }
#endif

}  // namespace freiform
