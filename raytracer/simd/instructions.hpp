// A table of kernels that are compiled once for each instruction set, of which one is chosen when the program starts.
#pragma once

namespace deburr {

/// The kernels as compiled for one instruction set, and the set's name.
template <class Functions>
struct Instructions {
    const char* name;
    const Functions* functions;
};

}  // namespace deburr
