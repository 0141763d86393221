// oneTBB's loops on std::thread, only for builds with the thread sanitizer.
//
// Debian's oneTBB is not compiled with the sanitizer. The sanitizer therefore does not see that a task begins after it
// was spawned and ends before the loop returns, and would report every loop as a race. Its build finds this folder
// before oneTBB's own. The loops here promise what oneTBB's do and no more: they call the body once for each index, in
// any order, in at most as many threads as global_control allows, and rethrow one of the exceptions thrown.
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

// Number of threads that run besides the callers'; nested loops share the limit.
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
    /// Calls work() unless an earlier call has thrown.
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

/// Calls each(i) for every i < count.
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
