#include "raytracer/util/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

std::atomic<bool> stop{false}, saving{false}, announced{false}, terminal{false};
std::atomic<int> interrupts{0};                         // SIGINTs while there is something to save
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler might deadlock

// Functions that are safe in a signal handler are all that the following call.

void say(std::string_view text) {
    // A bar may stand on the terminal's line.
    if (terminal) [[maybe_unused]]
        const auto n = write(STDERR_FILENO, "\n", 1);
    [[maybe_unused]] const auto n = write(STDERR_FILENO, text.data(), text.size());
}

[[noreturn]] void end() {
    remove_unfinished_files();
    _exit(interrupted_exit_code);
}

void handle(int signal) {
    const int error = errno;
    if (!saving) {
        say(any_file_written() ? "deburr: interrupted: the files written before are kept\n"
                               : "deburr: interrupted: nothing is written\n");
        end();
    }
    if (signal == SIGINT && ++interrupts > 1) end();
    if (!stop.exchange(true) && announced)
        say("deburr: stopping after the work in hand; another Ctrl-C stops at once\n");
    errno = error;
}

void install() {
    terminal = isatty(STDERR_FILENO) == 1;
    struct sigaction action {};
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&action.sa_mask, signal);
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

}  // namespace

void end_on_interrupt() {
    saving = false;
    install();
}

const std::atomic<bool>& catch_interrupts(bool announce) {
    announced = announce;
    saving = true;
    install();
    return stop;
}

}  // namespace deburr
