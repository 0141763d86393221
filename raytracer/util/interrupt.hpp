// SIGINT (Ctrl-C) and SIGTERM.
//
// While there is nothing to save the first of them ends the process, whatever code runs at that moment: reading,
// building and meshing need no checks, and neither do libraries. While there is something to save it sets a flag.
#pragma once
#include <atomic>

namespace deburr {

/// Exit code of a run that was interrupted.
constexpr int interrupted_exit_code = 130;

/// From now on the first SIGINT or SIGTERM ends the process with exit code 130 and one line on stderr, and leaves no
/// half-written file.
void end_on_interrupt();

/// From now on the first SIGINT or SIGTERM sets the flag that is returned, and further SIGTERMs do nothing; a second
/// SIGINT ends the process at once, with exit code 130 and without leaving a half-written file. `announce` asks for
/// a line on stderr at the first.
const std::atomic<bool>& catch_interrupts(bool announce);

/// From now on a SIGTERM that ends the process does so with this exit code in place of 130.
void set_exit_code_of_terminated(int code);

/// Whether the first signal since catch_interrupts() was SIGTERM.
bool is_terminated();

/// From now on SIGUSR1 sets a flag instead of ending the process.
void catch_save_requests();

/// Whether there was a SIGUSR1 since it was last asked.
bool take_save_request();

}  // namespace deburr
