// A parallel loop (oneTBB) whose errors do not depend on which thread was quicker.
#pragma once
#include <tbb/parallel_for.h>

#include <exception>
#include <vector>

namespace deburr {

/// Calls work(i) for all i < count. What has failed is thrown at the end: of several errors that of the
/// least i.
template <class Work>
void in_parallel(std::size_t count, Work work) {
    std::vector<std::exception_ptr> errors(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
        try {
            work(i);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
}

}  // namespace deburr
