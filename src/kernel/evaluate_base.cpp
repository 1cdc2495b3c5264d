// The instructions that every machine of its kind has: SSE2, NEON, or those of WebAssembly.
#if defined(__aarch64__)
#define FF_KERNEL neon
#elif defined(__wasm_simd128__)
#define FF_KERNEL simd128
#else
#define FF_KERNEL base
#endif
#define FF_KERNELS kBase
#include "evaluate_generic.inl"
