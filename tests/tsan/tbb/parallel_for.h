// parallel_for on std::thread; see threads.hpp.
#pragma once
#include <tbb/blocked_range.h>
#include <tbb/partitioner.h>

#include "threads.hpp"

namespace tbb {

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
    if (first < last)
        on_threads::loop(std::size_t(last - first), [&](std::size_t i) { body(Index(first + Index(i))); });
}

// Ranges are split into pieces of one grain, as finely as the simple partitioner may split them.
template <class Index, class Body, class Partitioner = auto_partitioner>
void parallel_for(const blocked_range<Index>& range, const Body& body, const Partitioner& = {}) {
    const std::size_t grain = range.grainsize(), count = (range.size() + grain - 1) / grain;
    on_threads::loop(count, [&](std::size_t i) {
        const Index begin = range.begin() + Index(i * grain);
        body(blocked_range<Index>(begin, begin + Index(std::min<std::size_t>(grain, range.end() - begin)), grain));
    });
}

}  // namespace tbb
