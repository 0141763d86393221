// Exceptions by the exit code of the program that they lead to. Any other exception leads to 1.
#pragma once
#include <stdexcept>

namespace deburr {

/// The command line is wrong, and nothing was done: exit code 2 (as for a SceneError).
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The work failed, for example because the disk is full: exit code 1.
struct WorkError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The input is valid but needs something that is not supported or not installed: exit code 3.
struct UnsupportedError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace deburr
