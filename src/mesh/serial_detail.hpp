// Whether there is one thread: work that is only for several is left out then, and its code where there never
// are.
#pragma once
#include <freiform/core/parallel.hpp>

namespace freiform {

#ifdef FREIFORM_SERIAL
constexpr bool is_serial() { return true; }
#else
inline bool is_serial() { return max_threads() == 1; }
#endif

}  // namespace freiform
