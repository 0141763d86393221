#include "raytracer/util/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

// stop: the flag of catch_interrupts(); saving: there is something to save; announced: print a line at the first
// signal; terminal: stderr is one.
std::atomic<bool> stop{false}, saving{false}, announced{false}, terminal{false};
std::atomic<bool> terminated{false}, save_requested{false};
std::atomic<int> terminated_exit_code{interrupted_exit_code};
std::atomic<int> interrupts{0};                         // SIGINTs since there is something to save
static_assert(std::atomic<bool>::is_always_lock_free);  // otherwise a handler could deadlock

// The functions below call only functions that are safe in a signal handler.

void say(std::string_view text) {
    // A progress bar may be on the terminal's line.
    if (terminal) [[maybe_unused]]
        const auto n = write(STDERR_FILENO, "\n", 1);
    [[maybe_unused]] const auto n = write(STDERR_FILENO, text.data(), text.size());
}

[[noreturn]] void end(int signal) {
    remove_unfinished_files();
    _exit(signal == SIGTERM ? terminated_exit_code.load() : interrupted_exit_code);
}

void handle(int signal) {
    const int error = errno;
    if (!saving) {
        say(any_file_written() ? "deburr: interrupted: the files written before are kept\n"
                               : "deburr: interrupted: nothing is written\n");
        end(signal);
    }
    if (signal == SIGINT && ++interrupts > 1) end(signal);
    if (!stop && signal == SIGTERM) terminated = true;
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

void set_exit_code_of_terminated(int code) { terminated_exit_code = code; }

bool is_terminated() { return terminated; }

void catch_save_requests() {
    struct sigaction action {};
    action.sa_handler = [](int) { save_requested = true; };
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, nullptr);
}

bool take_save_request() { return save_requested.exchange(false); }

}  // namespace deburr
