#include "raytracer/util/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

std::atomic<bool> stop{false};
std::atomic<bool> announced{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler might deadlock

constexpr std::string_view message = "\ndeburr: stopping after the work in hand; once more stops at once\n";

// Only what is safe in a signal handler.
void handle(int) {
    if (stop.exchange(true)) {
        remove_unfinished_file();
        _exit(interrupted_exit_code);
    }
    const int error = errno;
    if (announced) {
        [[maybe_unused]] const auto n = write(STDERR_FILENO, message.data(), message.size());
    }
    errno = error;
}

}  // namespace

const std::atomic<bool>& catch_interrupts(bool announce) {
    announced = announce;
    struct sigaction action {};
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    return stop;
}

}  // namespace deburr
