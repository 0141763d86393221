// A closed interval of real numbers.
#pragma once
#include <algorithm>

namespace deburr {

/// The values from lo to hi, both included.
struct Range {
    double lo = 0, hi = 0;
};

/// The products of values of a and of b, which are finite.
inline Range product(Range a, Range b) {
    const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
    return {lo, hi};
}

}  // namespace deburr
