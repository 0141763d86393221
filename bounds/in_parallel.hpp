// A parallel loop (oneTBB) whose errors do not depend on which thread was quicker.
#pragma once
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

namespace deburr {

/// Calls work(i) for all i < count on several threads. If calls throw, the rest is abandoned and the error of the least
/// i that threw is rethrown at the end. Only one error is kept at a time, because a process that runs out of memory has
/// room for only a few hundred exceptions.
template <class Work>
void in_parallel(std::size_t count, Work work) {
    std::atomic<std::size_t> failed{count};  // the least i that has thrown so far; `count` if none has
    std::exception_ptr error;
    std::mutex mutex;
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
        if (i > failed) return;  // an error of a greater i would not be reported
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

/// Calls work(first, last) for consecutive ranges [first, last) of at most `most` numbers that together make up [0,
/// count). The ranges depend on `count` and `most` alone, not on the number of threads.
template <class Work>
void in_parallel_ranges(std::size_t count, std::size_t most, Work work) {
    in_parallel((count + most - 1) / most, [&](std::size_t k) { work(k * most, std::min(count, (k + 1) * most)); });
}

}  // namespace deburr
