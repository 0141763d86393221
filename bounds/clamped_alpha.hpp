// α clamped to [−1, 1], the interval in which a density varies, without branches: a processor cannot predict whether α
// is in it, and compilers turn comparisons into branches here, because the density outside of [−1, 1] is a constant.
#pragma once

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace deburr {

/// Same as std::clamp(alpha, -1.0, 1.0).
inline double clamped_alpha(double alpha) {
#if defined(__SSE2__)
    return _mm_cvtsd_f64(_mm_max_sd(_mm_min_sd(_mm_set_sd(alpha), _mm_set_sd(1)), _mm_set_sd(-1)));
#else
    const double least = alpha < 1 ? alpha : 1;
    return least > -1 ? least : -1;
#endif
}

/// Two doubles in one vector register.
using DoublePair = double __attribute__((vector_size(16)));

inline DoublePair clamped_alpha(DoublePair alpha) {
    const DoublePair one{1, 1}, least = alpha < one ? alpha : one;
    return least > -one ? least : -one;
}

}  // namespace deburr
