// How far a piece of work is whose end nobody knows before: phases take shares of what is left.
#pragma once
#include <algorithm>
#include <functional>
#include <mutex>

namespace deburr {

/// From 0 to 1, and never back; safe from many threads.
class WorkProgress {
public:
    /// `done` is told what share of the whole was done since the last time; empty: nobody asks.
    explicit WorkProgress(std::function<void(double share)> done) : done_(std::move(done)) {}

    /// The phase before is over; the next one takes this share of what is left.
    void begin(double share_of_rest) {
        const std::lock_guard lock(mutex_);
        reach(end_);
        end_ = reached_ + share_of_rest * (1 - reached_);
        begin_ = reached_;
    }
    /// This share of the phase is done, beside what was done of it before.
    void advance(double share) {
        const std::lock_guard lock(mutex_);
        reach(std::min(end_, reached_ + share * (end_ - begin_)));
    }
    /// All is done.
    void finish() {
        const std::lock_guard lock(mutex_);
        reach(1);
    }

private:
    void reach(double share) {
        if (share <= reached_) return;
        if (done_) done_(share - reached_);
        reached_ = share;
    }

    const std::function<void(double)> done_;
    std::mutex mutex_;
    double begin_ = 0, end_ = 0, reached_ = 0;
};

}  // namespace deburr
