// How far the work is: a bar with the time left on a terminal, a line now and then elsewhere; for other programs, lines
// of a fixed form or JSON.
//
// Measured in work, with the writing of files in it, so that 100 % means that everything is done;
// it never goes back. The time left supposes that the rest goes as fast as what is done.
#pragma once
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace deburr {

class Progress {
public:
    enum class Style {
        none,
        bar,
        lines,
        farm,  // "Progress: 42%" at every percent, as render farms look for it
        json,  // an object a line, once a second and at the end
    };

    struct Output {
        Style style = Style::none;
        int columns = 80;                             // width of the bar's line
        std::function<void(std::string_view)> print;  // takes whole lines, or a bar to overwrite
        std::function<double()> now;                  // seconds
    };

    /// Output to stderr: a bar if it is a terminal, else lines. `quiet`: nothing at all.
    static Output standard_error(bool quiet);
    static Output standard_error(Style style);

    /// The clock starts here. total > 0, in units of the caller's choice; `done` of it were done by an earlier run.
    Progress(double total, Output output, double done = 0);

    /// `work` ≥ 0 more is done; safe from many threads.
    void advance(double work);
    /// Everything is done.
    void finish();
    /// Ends the bar's line where it is, so that a message can follow.
    void stop();

private:
    void show(double now);
    void show_json(double share, double now, const char* event);
    /// Seconds, once anything is known of them.
    std::optional<double> left(double now) const;

    const Output output_;
    const double total_;
    std::mutex mutex_;
    double start_, start_done_, done_, shown_at_;
    int shown_percent_ = 0;
    bool open_ = false, finished_ = false;
};

/// 75 → "1:15", 3675 → "1:01:15"; rounded up to whole seconds.
std::string clock_time(double seconds);

}  // namespace deburr
