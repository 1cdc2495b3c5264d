// For processors with AVX-512 (F, DQ, VL).
#if defined(__x86_64__)
#define FF_KERNEL avx512
#define FF_KERNELS kAvx512
#include "evaluate_generic.inl"
#endif
