// The one body of all kernels. Included by a file for each instruction set, which says its name.
#include "degree.hpp"
#include "evaluate.hpp"

#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace freiform::kernel {
namespace FF_KERNEL {
namespace {
#include "vectors.inl"
//
#include "jets.inl"
//
#include "locate.inl"
//
#include "finish.inl"
//
#include "scattered.inl"
//
#include "grid.inl"
}  // namespace
}  // namespace FF_KERNEL

#define FF_TEXT_OF(x) #x
#define FF_TEXT(x) FF_TEXT_OF(x)
const Kernels FF_KERNELS = {FF_TEXT(FF_KERNEL),  FF_KERNEL::kWidth,  FF_KERNEL::scattered, FF_KERNEL::weights,
                            FF_KERNEL::grid_row, FF_KERNEL::combine, FF_KERNEL::flush,     FF_KERNEL::inside};

}  // namespace freiform::kernel
