// Reads the pages of docs/ for tests.
#pragma once
#include <string>
#include <vector>

#include "raytracer/cli/scene_page.hpp"

namespace deburr::test {

/// The text of the file at `path` from the project's root. Fails the test if it cannot be read.
std::string project_file(const std::string& path);

/// The parts of docs/scenes.md as it is in the project.
std::vector<PagePart> scene_parts();

/// The code blocks between ```lua and ```.
std::vector<std::string> lua_blocks(const std::string& markdown);

/// A row of a table: the names of the table's columns, and the row's cells without surrounding blanks.
struct Row {
    std::vector<std::string> columns, cells;
    /// The cell in this column; "" if the table has no such column.
    std::string cell(const std::string& column) const;
};

/// The rows of all tables of the text, without their headers.
std::vector<Row> rows_of(const std::string& markdown);

/// The text in the first pair of backticks; "" if there is none.
std::string quoted(const std::string& text);

}  // namespace deburr::test
