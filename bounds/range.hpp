// A closed interval of real numbers.
#pragma once

namespace deburr {

/// The values from lo to hi, both included.
struct Range {
    double lo = 0, hi = 0;
};

}  // namespace deburr
