// oneTBB's loops on std::thread, for the thread sanitizer alone.
//
// Debian's oneTBB is not compiled with the sanitizer, which so does not see that a task begins after it was spawned and
// ends before the loop returns: every loop would be a race. The sanitizer's build finds this folder before oneTBB's
// own; the loops in it promise no more than oneTBB's: each call of a body once, in any order, in as many threads as
// global_control allows, and of what bodies throw one exception at the end.
#pragma once
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb::on_threads {

// Threads beside the caller's that run now; nested loops share what is allowed.
inline std::atomic<int> helpers{0};

inline bool take_helper() {
    const int most = int(global_control::active_value(global_control::max_allowed_parallelism)) - 1;
    int now = helpers;
    while (now < most)
        if (helpers.compare_exchange_weak(now, now + 1)) return true;
    return false;
}

class FirstError {
public:
    /// Calls work() unless another has failed.
    template <class Work>
    void guard(const Work& work) {
        if (failed_) return;
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!error_) error_ = std::current_exception();
            failed_ = true;
        }
    }
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
    }

private:
    std::atomic<bool> failed_{false};
    std::mutex mutex_;
    std::exception_ptr error_;
};

/// Calls each(i) for all i < count.
template <class Each>
void loop(std::size_t count, const Each& each) {
    FirstError errors;
    std::atomic<std::size_t> next{0};
    const auto run = [&] {
        for (std::size_t i; (i = next++) < count;) errors.guard([&] { each(i); });
    };
    std::vector<std::thread> threads;
    while (threads.size() + 1 < count && take_helper())
        threads.emplace_back([&] {
            run();
            --helpers;
        });
    run();
    for (std::thread& thread : threads) thread.join();
    errors.rethrow();
}

}  // namespace tbb::on_threads
