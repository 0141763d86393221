// The entry point of the program deburr.
#include "figures/command_figures.hpp"
#include "raytracer/cli/command_line.hpp"

int main(int argc, char** argv) { return deburr::run_program(argc, argv, {deburr::add_figures_command}); }
