// The program's commands. Each is implemented in its own file, NAME_command.cpp, declared here and added by
// run_program().
#pragma once
#include <CLI/App.hpp>
#include <functional>
#include <string>

namespace deburr {

/// A command of the program. `run` is called after the whole command line was parsed; it returns the exit code and may
/// throw.
struct Command {
    CLI::App* app;
    std::function<int()> run;
};

/// Adds an empty command to the program. Through this function only command_line.cpp needs <CLI/CLI.hpp>, which defines
/// CLI11's parser and help; all other files include <CLI/App.hpp>, which saves 2 s of compiling each.
CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& description);

Command add_render_command(CLI::App& program);
Command add_info_command(CLI::App& program);
Command add_mesh_command(CLI::App& program);
Command add_compare_command(CLI::App& program);
Command add_export_pov_command(CLI::App& program);
Command add_merge_command(CLI::App& program);
Command add_view_command(CLI::App& program);
Command add_help_command(CLI::App& program);

}  // namespace deburr
