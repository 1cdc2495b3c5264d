// The instructions that every machine of its kind has.
#define FF_KERNEL base
#define FF_KERNELS kBaseBlocks
#include "blocks_generic.inl"
