// Runs the program from its arguments to the exit code: 0 success, 1 the work failed, 2 wrong usage or scene, 3 not
// supported, 130 interrupted. Errors are one line on stderr.
#pragma once
#include <vector>

#include "raytracer/cli/commands.hpp"

namespace deburr {

/// Runs the program. `more` adds commands from folders above this one.
int run_program(int argc, char** argv, const std::vector<Command (*)(CLI::App&)>& more = {});

}  // namespace deburr
