// For processors with AVX2 and FMA.
#if defined(__x86_64__)
#define FF_KERNEL avx2
#define FF_KERNELS kAvx2
#include "evaluate_generic.inl"
#endif
