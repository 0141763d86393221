#include "raytracer/command_line.hpp"

int main(int argc, char** argv) { return deburr::run_program(argc, argv); }
