// Shows the progress of the work: on a terminal a bar with the time left, elsewhere a line now and then; for other
// programs, lines of a fixed form or JSON.
//
// Progress is measured in units of work that include writing files, so that 100 % means that everything is done; it
// never decreases. The time left assumes that the rest goes as fast as the work done so far.
#pragma once
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace deburr {

/// The progress of one run.
class Progress {
public:
    /// The form in which progress is shown.
    enum class Style {
        none,   // not at all
        bar,    // a bar that is overwritten
        lines,  // a line every ten percent or ten seconds
        farm,   // "Progress: 42%" at every percent, the form that render farms parse
        json,   // an object per line, once a second and at the end
    };

    /// The destination of progress, with its form.
    struct Output {
        Style style = Style::none;
        int columns = 80;                             // width of the terminal
        std::function<void(std::string_view)> print;  // takes whole lines, or a bar to be overwritten
        std::function<double()> now;                  // a clock, in seconds
    };

    /// Output to stderr: a bar if it is a terminal, else lines; none if `quiet`.
    static Output standard_error(bool quiet);
    static Output standard_error(Style style);

    /// Starts the clock. `total` > 0 is the amount of work in units of the caller's choice, of which an earlier run did
    /// `done`.
    Progress(double total, Output output, double done = 0);

    /// Adds `work` ≥ 0 to what is done. Thread-safe.
    void advance(double work);
    /// Marks everything as done.
    void finish();
    /// Ends the bar's line as it is, so that a message can follow.
    void stop();

private:
    void show(double now);
    void show_json(double share, double now, const char* event);
    /// The estimated seconds left; empty while nothing is done.
    std::optional<double> left(double now) const;

    const Output output_;
    const double total_;
    std::mutex mutex_;
    double start_, start_done_, done_, shown_at_;
    int shown_percent_ = 0;
    bool open_ = false, finished_ = false;
};

/// A duration rounded up to whole seconds: 75 → "1:15", 3675 → "1:01:15".
std::string clock_time(double seconds);

}  // namespace deburr
