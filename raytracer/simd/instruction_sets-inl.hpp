// Finds out which instruction sets this machine has, among those that a file of kernels is compiled for. Such a file
// includes this one once (under HWY_ONCE), after Highway's headers.
//
// Highway's own dispatch would need its library, which measures the processor's clock before main(): 3 ms.
#pragma once
#include <vector>

#include "raytracer/simd/instructions.hpp"

#if HWY_ARCH_ARM_A64
#include <asm/hwcap.h>
#include <sys/auxv.h>
#endif

namespace deburr {

#if HWY_ARCH_X86
inline bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi2");
}
inline bool has_avx2() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
}
inline bool has_sse4() { return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul"); }
#endif
#if HWY_ARCH_ARM_A64
inline bool has_neon() { return (getauxval(AT_HWCAP) & HWCAP_AES) != 0; }  // AES is part of that set
#endif

}  // namespace deburr

// DEBURR_INSTRUCTION_SETS is the body of a function that returns a std::vector<Instructions<Functions>>, the widest set
// first. `functions` is the table that every HWY_NAMESPACE defines.
#if HWY_TARGETS & HWY_AVX3
#define DEBURR_AVX512(functions) \
    if (has_avx512()) there.push_back({"AVX-512", &N_AVX3::functions});
#else
#define DEBURR_AVX512(functions)
#endif
#if HWY_TARGETS & HWY_AVX2
#define DEBURR_AVX2(functions) \
    if (has_avx2()) there.push_back({"AVX2", &N_AVX2::functions});
#else
#define DEBURR_AVX2(functions)
#endif
#if HWY_TARGETS & HWY_SSE4
#define DEBURR_SSE4(functions) \
    if (has_sse4()) there.push_back({"SSE4", &N_SSE4::functions});
#else
#define DEBURR_SSE4(functions)
#endif
#if HWY_ARCH_ARM_A64 && (HWY_TARGETS & HWY_NEON) && HWY_STATIC_TARGET != HWY_NEON
#define DEBURR_NEON(functions) \
    if (has_neon()) there.push_back({"NEON", &N_NEON::functions});
#else
#define DEBURR_NEON(functions)
#endif
#define DEBURR_INSTRUCTION_SETS(Functions, functions)               \
    std::vector<Instructions<Functions>> there;                     \
    DEBURR_AVX512(functions)                                        \
    DEBURR_AVX2(functions)                                          \
    DEBURR_SSE4(functions)                                          \
    DEBURR_NEON(functions)                                          \
    there.push_back({"baseline", &HWY_STATIC_DISPATCH(functions)}); \
    return there;
