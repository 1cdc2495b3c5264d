// Whether there is one thread: work that is only for several is left out then, and its code where there never
// are.
#pragma once
#include <freiform/core/parallel.hpp>

namespace freiform {

#ifdef FREIFORM_SERIAL
constexpr bool kIsSerialBuild = true;
#else
constexpr bool kIsSerialBuild = false;
#endif
// Others may change the number of threads meanwhile.
inline bool is_serial() { return kIsSerialBuild || max_threads() == 1; }

}  // namespace freiform
