#include "raytracer/util/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace deburr {
namespace {

constexpr double bar_interval = 0.1;                // seconds: looks smooth and costs nothing
constexpr double json_interval = 1;                 // seconds: often enough for a page that shows it
constexpr double line_interval = 10;                // seconds: a log shows that the work continues
constexpr int line_percent = 10;                    // or every ten percent
constexpr double first_line_after = 1;              // seconds: short work needs no progress lines
constexpr int narrowest_bar = 10, widest_bar = 50;  // columns

}  // namespace

std::string clock_time(double seconds) {
    const auto s = std::int64_t(std::ceil(std::clamp(seconds, 0.0, 1e9)));
    if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    return fmt::format("{}:{:02}", s / 60, s % 60);
}

Progress::Output Progress::standard_error(bool quiet) {
    return standard_error(quiet ? Style::none : isatty(STDERR_FILENO) ? Style::bar : Style::lines);
}

Progress::Output Progress::standard_error(Style style) {
    Output output;
    output.style = style;
    output.now = [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
    output.print = [](std::string_view text) {
        std::fwrite(text.data(), 1, text.size(), stderr);
        std::fflush(stderr);
    };
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) output.columns = size.ws_col;
    return output;
}

Progress::Progress(double total, Output output, double done)
    : output_(std::move(output)),
      total_(total),
      start_(output_.now ? output_.now() : 0),
      start_done_(done),
      done_(done),
      shown_at_(start_) {}

void Progress::advance(double work) {
    if (output_.style == Style::none) return;
    const std::lock_guard lock(mutex_);
    done_ = std::min(done_ + work, total_);
    show(output_.now());
}

void Progress::show(double now) {
    // The last percent is left to finish(): nothing is done before its file is written.
    const double share = finished_ ? 1.0 : std::min(done_ / total_, 0.99);
    const int percent = int(100 * share);
    const double elapsed = now - start_;
    std::string rest;
    if (finished_)
        rest = elapsed < 60 ? fmt::format("in {:.1f} s", elapsed) : "in " + clock_time(elapsed);
    else if (const auto seconds = left(now))
        rest = clock_time(*seconds) + " left";
    if (output_.style == Style::json) {
        if (!finished_ && now - shown_at_ < json_interval) return;
        show_json(share, now, finished_ ? "done" : "progress");
    } else if (output_.style == Style::farm) {
        if (!finished_ && percent == shown_percent_) return;
        output_.print(fmt::format("Progress: {}%  {}\n", percent, rest));
    } else if (output_.style == Style::bar) {
        if (open_ && !finished_ && now - shown_at_ < bar_interval) return;
        const int room = output_.columns - 1 - int(std::string_view("[] 100 %  00:00:00 left").size());
        const int bar = std::clamp(room, narrowest_bar, widest_bar);
        const int full = int(share * bar);
        // Padded to the length of the longest text, to overwrite it.
        output_.print(fmt::format("\r[{}{}] {:3} %  {:<13}", std::string(std::size_t(full), '#'),
                                  std::string(std::size_t(bar - full), '.'), percent, rest));
        open_ = true;
    } else {
        const bool due = percent / line_percent > shown_percent_ / line_percent || now - shown_at_ >= line_interval;
        if (!finished_ && (!due || elapsed < first_line_after)) return;
        output_.print(fmt::format("{:3} %  {}\n", percent, rest));
    }
    shown_at_ = now;
    shown_percent_ = percent;
}

std::optional<double> Progress::left(double now) const {
    if (!(done_ > start_done_)) return std::nullopt;
    return (now - start_) * (total_ - done_) / (done_ - start_done_);
}

void Progress::show_json(double share, double now, const char* event) {
    const auto seconds = left(now);
    output_.print(
        fmt::format("{{\"event\": \"{}\", \"fraction\": {:.4f}, \"seconds\": {:.1f}, \"seconds_left\": {}}}\n", event,
                    share, now - start_, seconds ? fmt::format("{:.1f}", *seconds) : "null"));
}

void Progress::finish() {
    if (output_.style == Style::none || finished_) return;
    const std::lock_guard lock(mutex_);
    finished_ = true;
    done_ = total_;
    show(output_.now());
    if (open_) output_.print("\n");
    open_ = false;
}

void Progress::stop() {
    const std::lock_guard lock(mutex_);
    if (output_.style == Style::json && !finished_) {
        show_json(std::min(done_ / total_, 0.99), output_.now(), "stopped");
        finished_ = true;
    }
    if (open_) output_.print("\n");
    open_ = false;
}

}  // namespace deburr
