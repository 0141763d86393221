// Sets of instructions that Highway knows and kernels are not compiled for: those that differ little from their
// neighbours, and those whose vectors have a size that is not known here. To be included before Highway.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
