// A parallel loop (oneTBB) whose errors do not depend on which thread was quicker.
#pragma once
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

namespace deburr {

/// Calls work(i) for all i < count, or until one fails: of several errors that of the least i is thrown, at the end.
/// One error is kept at a time, for without memory there is room for a few hundred exceptions only.
template <class Work>
void in_parallel(std::size_t count, Work work) {
    std::atomic<std::size_t> failed{count};  // the least i so far
    std::exception_ptr error;
    std::mutex mutex;
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
        if (i > failed) return;  // what it might throw would not be told
        try {
            work(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (i > failed) return;
            failed = i;
            error = std::current_exception();
        }
    });
    if (error) std::rethrow_exception(error);
}

/// Calls work(first, last) for ranges of no more than `most` that make up all i < count; they depend on these two
/// alone.
template <class Work>
void in_parallel_ranges(std::size_t count, std::size_t most, Work work) {
    in_parallel((count + most - 1) / most, [&](std::size_t k) { work(k * most, std::min(count, (k + 1) * most)); });
}

}  // namespace deburr
