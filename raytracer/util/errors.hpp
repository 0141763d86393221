// What may go wrong, by the exit code it leads to. Anything else that is thrown is a 1.
#pragma once
#include <stdexcept>

namespace deburr {

/// The call is wrong, and nothing was done: exit code 2 (as is a SceneError).
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The work failed, for example for want of disk space: exit code 1.
struct WorkError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The input is right but needs something that is not supported: exit code 3.
struct UnsupportedError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace deburr
