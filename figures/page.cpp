#include "figures/page.hpp"

#include <algorithm>
#include <filesystem>

namespace deburr {
namespace {

namespace fs = std::filesystem;

// Width of the text on the page, in pixels.
constexpr int page_width = 880;

std::string image(const FigureItem& item, int width) {
    return fmt::format("<img src=\"{}\" width=\"{}\" alt=\"{}\">", item.file, std::min(width, item.width),
                       item.caption.empty() ? item.file : item.caption);
}

std::string picture_cell(const FigureItem& item, int width) {
    std::string cell = image(item, width);
    if (!item.caption.empty()) cell += "<br>" + item.caption;
    for (const std::string& other : item.others)
        cell += fmt::format(" [{}]({})", fs::path(other).extension().string().substr(1), other);
    return cell;
}

std::string row(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

std::string rule(std::size_t columns, const char* how) {
    std::string out = "|";
    for (std::size_t i = 0; i < columns; ++i) out += fmt::format("{}|", how);
    return out + "\n";
}

std::string table_of(const FigureTable& table) {
    // Names are aligned to the left, numbers to the right.
    std::string out = row(table.head) + "|---|";
    for (std::size_t i = 1; i < table.head.size(); ++i) out += "--:|";
    out += "\n";
    for (const auto& cells : table.rows) out += row(cells);
    return out + "\n";
}

// The items of a figure in Markdown; neighbouring pictures form rows.
std::string items_of(const FigureResult& result) {
    std::string out;
    for (std::size_t i = 0; i < result.items.size();) {
        if (result.items[i].file.empty()) {
            out += table_of(result.items[i++].table);
            continue;
        }
        std::size_t end = i;
        while (end < result.items.size() && !result.items[end].file.empty()) ++end;
        const std::size_t columns = std::min(end - i, std::size_t(std::max(1, result.columns)));
        if (columns == 1) {
            for (; i < end; ++i) out += picture_cell(result.items[i], page_width) + "\n\n";
            continue;
        }
        const int width = page_width / int(columns);
        for (bool first = true; i < end; first = false) {
            std::vector<std::string> cells;
            for (std::size_t k = 0; k < columns; ++k)
                cells.push_back(i < end ? picture_cell(result.items[i++], width) : "");
            out += row(cells);
            if (first) out += rule(columns, ":-:");
        }
        out += "\n";
    }
    return out;
}

std::string scenes_of(const Figure& figure, const fs::path& scenes, const fs::path& folder) {
    std::string out;
    std::error_code error;
    for (const std::string& name : figure.scenes) {
        const fs::path link = fs::relative(scenes / name, folder, error);
        out += fmt::format("{}[scenes/{}]({})", out.empty() ? "" : ", ", name, link.generic_string());
    }
    return out;
}

}  // namespace

std::string page_of(const std::vector<ShownFigure>& figures, const std::string& folder,
                    const std::string& scene_folder) {
    std::string out =
        "# Figures and tables of the papers\n\n"
        "Made by `deburr figures`, each from the program itself: *claim* is what the paper says, *measured* "
        "what the run that made the picture found. Times are CPU times, compared within that run.\n";
    std::string paper;
    for (const auto& [figure, result] : figures) {
        if (paper_of(*figure) != paper) {
            paper = paper_of(*figure);
            out += fmt::format("\n## {}\n", paper);
        }
        out += fmt::format("\n<a id=\"{}\"></a>\n\n### {}\n\n", figure->name, figure->title);
        if (!figure->shows.empty()) out += figure->shows + "\n\n";
        out += items_of(*result);
        if (!figure->claim.empty()) out += "**Claim.** " + figure->claim + "\n\n";
        if (!result->measured.empty()) {
            out += "**Measured.**";
            for (const std::string& line : result->measured) out += " " + line;
            out += "\n\n";
        }
        const std::string scenes = scenes_of(*figure, scene_folder, folder);
        out += fmt::format("`deburr figures {}`{}\n", figure->name, scenes.empty() ? "" : ", from " + scenes);
    }
    return out;
}

}  // namespace deburr
