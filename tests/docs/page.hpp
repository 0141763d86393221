// The pages of docs/ as tests read them.
#pragma once
#include <string>
#include <vector>

#include "raytracer/cli/scene_page.hpp"

namespace deburr::test {

/// The text of a file of the project. Fails the test if there is none.
std::string project_file(const std::string& path);

/// The parts of docs/scenes.md as the file has it now.
std::vector<PagePart> scene_parts();

/// The pieces of code between ```lua and ```.
std::vector<std::string> lua_blocks(const std::string& markdown);

/// A table's row under its header: name of column, and cell without blanks around it.
struct Row {
    std::vector<std::string> columns, cells;
    /// The column's cell; "" if the table has no such column.
    std::string cell(const std::string& column) const;
};

/// The rows of all tables, without headers.
std::vector<Row> rows_of(const std::string& markdown);

/// What stands in the first pair of backticks; "" if nothing does.
std::string quoted(const std::string& text);

}  // namespace deburr::test
