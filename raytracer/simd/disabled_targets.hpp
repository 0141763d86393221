// Instruction sets of Highway's that kernels are not compiled for: those that differ little from their neighbours, and
// those whose vector size is not known at compile time. Must be included before Highway.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
