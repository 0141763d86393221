// Kernels that are compiled once for each set of vector instructions, and chosen when the program starts.
#pragma once

namespace deburr {

/// Kernels as compiled for one set of instructions, and the set's name.
template <class Functions>
struct Instructions {
    const char* name;
    const Functions* functions;
};

}  // namespace deburr
