// DEBURR_INLINE marks what is inlined into kernels, whatever its size.
//
// With sanitizers clang takes ten minutes over the functions that come of it (a loop of 30,000 instructions), and half
// of one where it may choose.
#pragma once

#if DEBURR_IS_SANITIZED
#define DEBURR_INLINE inline
#else
#define DEBURR_INLINE HWY_INLINE
#endif
