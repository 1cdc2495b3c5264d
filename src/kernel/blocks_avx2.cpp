// For processors with AVX2.
#if defined(__x86_64__)
#define FF_KERNEL avx2
#define FF_KERNELS kAvx2Blocks
#include "blocks_generic.inl"
#endif
