// `deburr figures`: reproduces the papers' figures and tables.
#pragma once
#include "raytracer/cli/commands.hpp"

namespace deburr {

Command add_figures_command(CLI::App& program);

}  // namespace deburr
