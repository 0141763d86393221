// Documents about the command line, made from the commands' own definitions: nothing is written down twice.
//
// Options and commands of an empty group are hidden and left out.
#pragma once
#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace deburr {

/// The commands of the program, without hidden ones.
std::vector<const CLI::App*> commands_of(const CLI::App& program);

/// All spellings of the command's options: "-o", "--output".
std::vector<std::string> option_names(const CLI::App& command);

/// A table of the command's arguments and options, in Markdown.
std::string markdown_options(const CLI::App& command);

/// The program's manual page, section 1, in the man macros.
std::string man_page(const CLI::App& program);

/// The completion script for a shell: bash, zsh or fish; "" for any other.
std::string completion_script(const CLI::App& program, const std::string& shell);

}  // namespace deburr
