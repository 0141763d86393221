// Documents about the command line, generated from the commands' own definitions: tables in Markdown, the manual page
// and shell completions. Options and commands in an empty group are hidden and left out.
#pragma once
#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace deburr {

/// The program's commands, without hidden ones.
std::vector<const CLI::App*> commands_of(const CLI::App& program);

/// All spellings of the command's options, such as "-o" and "--output".
std::vector<std::string> option_names(const CLI::App& command);

/// A Markdown table of the command's arguments and options.
std::string markdown_options(const CLI::App& command);

/// The program's manual page (section 1), in man macros.
std::string man_page(const CLI::App& program);

/// The completion script for bash, zsh or fish; "" for any other shell.
std::string completion_script(const CLI::App& program, const std::string& shell);

}  // namespace deburr
