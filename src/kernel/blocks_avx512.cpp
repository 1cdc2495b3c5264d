// For processors with AVX-512: vectors stay as long, there are more of them.
#if defined(__x86_64__)
#define FF_KERNEL avx512
#define FF_KERNELS kAvx512Blocks
#include "blocks_generic.inl"
#endif
