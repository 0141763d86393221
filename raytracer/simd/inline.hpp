// DEBURR_INLINE marks functions that must be inlined into kernels whatever their size.
//
// With sanitizers clang takes ten minutes to compile the resulting functions (a loop of 30,000 instructions), and half
// a minute if it may choose; so then it may.
#pragma once

#if DEBURR_IS_SANITIZED
#define DEBURR_INLINE inline
#else
#define DEBURR_INLINE HWY_INLINE
#endif
