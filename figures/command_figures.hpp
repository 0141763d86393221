// deburr figures: the papers' figures and tables, made anew.
#pragma once
#include "raytracer/cli/commands.hpp"

namespace deburr {

Command add_figures_command(CLI::App& program);

}  // namespace deburr
