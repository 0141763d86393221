// Progress of work whose amount nobody knows beforehand: each phase takes a fraction of what is left.
#pragma once
#include <algorithm>
#include <functional>
#include <mutex>

namespace deburr {

/// Progress from 0 to 1, which never decreases. Safe to use from several threads.
class WorkProgress {
public:
    /// `done` is called with the fraction of the whole that was done since its last call; it may be empty.
    explicit WorkProgress(std::function<void(double share)> done) : done_(std::move(done)) {}

    /// Ends the current phase and begins one that takes this fraction of the remaining work.
    void begin(double share_of_rest) {
        const std::lock_guard lock(mutex_);
        reach(end_);
        end_ = reached_ + share_of_rest * (1 - reached_);
        begin_ = reached_;
    }
    /// Reports that another fraction `share` of the current phase is done.
    void advance(double share) {
        const std::lock_guard lock(mutex_);
        reach(std::min(end_, reached_ + share * (end_ - begin_)));
    }
    /// Reports that all work is done.
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
