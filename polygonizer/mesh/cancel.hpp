// How a polygonization is ended before its time: by a flag that another thread sets.
#pragma once
#include <atomic>

namespace deburr {

/// Null: nobody asks for an end.
using CancelFlag = const std::atomic<bool>*;

/// Thrown where the flag asks for an end.
struct Cancelled {};

inline void throw_if_cancelled(CancelFlag cancel) {
    if (cancel && cancel->load(std::memory_order_relaxed)) throw Cancelled();
}

}  // namespace deburr
