// An interval of values.
#pragma once

namespace deburr {

struct Range {
    double lo = 0, hi = 0;
};

}  // namespace deburr
