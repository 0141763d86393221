// The program's commands. Each is a file of its own, NAME_command.cpp; it is declared here and added to the program by
// run_program().
#pragma once
#include <CLI/App.hpp>
#include <functional>
#include <string>

namespace deburr {

/// `run` returns the exit code and may throw; it is called once the whole command line was read.
struct Command {
    CLI::App* app;
    std::function<int()> run;
};

/// Adds an empty command to the program. So only command_line.cpp compiles what CLI11 constructs with it, the parser
/// and the writer of help, and <CLI/CLI.hpp>, which defines them: 2 s of every other file with <CLI/App.hpp> instead.
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
