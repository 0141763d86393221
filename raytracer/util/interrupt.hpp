// Handling of SIGINT (Ctrl-C), SIGTERM and SIGUSR1.
//
// While there is nothing to save, the first SIGINT or SIGTERM ends the process, whatever code is running: reading,
// building and meshing need no checks, nor do libraries. While there is something to save, it sets a flag.
#pragma once
#include <atomic>

namespace deburr {

/// Exit code of an interrupted run.
constexpr int interrupted_exit_code = 130;

/// Makes the first SIGINT or SIGTERM end the process with exit code 130 and one line on stderr, leaving no half-written
/// file.
void end_on_interrupt();

/// Makes the first SIGINT or SIGTERM set the flag that is returned. Further SIGTERMs do nothing; a second SIGINT ends
/// the process at once with exit code 130, leaving no half-written file. With `announce`, the first signal prints a
/// line on stderr.
const std::atomic<bool>& catch_interrupts(bool announce);

/// Sets the exit code of a process that a SIGTERM ends, in place of 130.
void set_exit_code_of_terminated(int code);

/// Whether the first signal caught since catch_interrupts() was SIGTERM.
bool is_terminated();

/// Makes SIGUSR1 set a flag instead of ending the process.
void catch_save_requests();

/// Whether SIGUSR1 arrived since the last call.
bool take_save_request();

}  // namespace deburr
