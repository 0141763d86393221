// Cancels a polygonization by a flag that another thread sets.
#pragma once
#include <atomic>

namespace deburr {

/// A flag that is true once the work is to be cancelled; null if nobody can cancel it. Whoever passes it owns it.
using CancelFlag = const std::atomic<bool>*;

/// Thrown by throw_if_cancelled().
struct Cancelled {};

/// Throws Cancelled if the flag is set. To be called every few milliseconds of work.
inline void throw_if_cancelled(CancelFlag cancel) {
    if (cancel && cancel->load(std::memory_order_relaxed)) throw Cancelled();
}

}  // namespace deburr
