// How a polygonization is ended before its time: by a flag that another thread sets.
#pragma once
#include <atomic>

namespace deburr {

/// Null: nobody asks for an end.
using StopFlag = const std::atomic<bool>*;

/// Thrown where the flag asks for an end.
struct Stopped {};

inline void throw_if_stopped(StopFlag stop) {
    if (stop && stop->load(std::memory_order_relaxed)) throw Stopped();
}

}  // namespace deburr
