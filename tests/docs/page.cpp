#include "docs/page.hpp"

#include <fstream>
#include <regex>
#include <sstream>

#include "catch.hpp"

namespace deburr::test {

std::string project_file(const std::string& path) {
    std::ifstream file(DEBURR_SOURCE_DIR "/" + path);
    INFO(path);
    REQUIRE(file);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<PagePart> scene_parts() { return parts_of_page(project_file("docs/scenes.md")); }

std::vector<std::string> lua_blocks(const std::string& markdown) {
    std::vector<std::string> blocks;
    const std::string start = "```lua\n";
    for (std::size_t at = 0; (at = markdown.find(start, at)) != std::string::npos;) {
        at += start.size();
        const std::size_t end = markdown.find("```", at);
        blocks.push_back(markdown.substr(at, end - at));
        at = end;
    }
    return blocks;
}

std::string Row::cell(const std::string& column) const {
    for (std::size_t i = 0; i < columns.size() && i < cells.size(); ++i)
        if (columns[i] == column) return cells[i];
    return "";
}

std::vector<Row> rows_of(const std::string& markdown) {
    std::vector<Row> rows;
    std::vector<std::string> columns;
    std::istringstream lines(markdown);
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] != '|') {
            columns.clear();
            continue;
        }
        std::vector<std::string> cells;
        static const std::regex cell(R"(\|\s*([^|]*?)\s*(?=\|))");
        for (std::sregex_iterator at(line.begin(), line.end(), cell), end; at != end; ++at) cells.push_back((*at)[1]);
        if (columns.empty())
            columns = cells;
        else if (line.substr(0, 3) != "|--")
            rows.push_back({columns, cells});
    }
    return rows;
}

std::string quoted(const std::string& text) {
    const std::size_t first = text.find('`');
    if (first == std::string::npos) return "";
    return text.substr(first + 1, text.find('`', first + 1) - first - 1);
}

}  // namespace deburr::test
