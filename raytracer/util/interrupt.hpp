// Ctrl-C and SIGTERM: the first asks for an end, the second is one.
#pragma once
#include <atomic>

namespace deburr {

/// Exit code of a run that was interrupted.
constexpr int interrupted_exit_code = 130;

/// From now on the first SIGINT or SIGTERM sets the flag that is returned; the second ends the
/// process at once, with exit code 130 and without leaving a half-written file. `announce` says the
/// first on stderr.
const std::atomic<bool>& catch_interrupts(bool announce);

}  // namespace deburr
