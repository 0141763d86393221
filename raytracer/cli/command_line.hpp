// From the words of a call to the exit code: 0 done, 1 the work failed, 2 the call or the scene is
// wrong, 3 not supported, 130 interrupted. An error is one line on stderr.
#pragma once
#include <vector>

#include "raytracer/cli/commands.hpp"

namespace deburr {

/// `more`: commands from folders above this one.
int run_program(int argc, char** argv, const std::vector<Command (*)(CLI::App&)>& more = {});

}  // namespace deburr
