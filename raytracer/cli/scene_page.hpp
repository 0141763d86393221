// The documentation page docs/scenes.md, which is compiled into the program, and its parts by name.
//
// A part is a heading with the text below it: the page's title, a topic ("Materials"), or an entry of a topic
// ("matte{…}"). `deburr help NAME` prints parts as plain text.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace deburr {

/// The whole page in Markdown.
std::string_view scene_page();

/// A part of the page.
struct PagePart {
    int level;                       // of the heading; 1: page, 2: topic, 3: entry
    std::string heading;             // in Markdown
    std::string text;                // between this heading and the next
    std::vector<std::string> names;  // such as "materials" and "material", "matte", "|"
};

/// The parts of `page` in order.
std::vector<PagePart> parts_of_page(std::string_view page);

/// The parts called `name`, ignoring case: the page and topics with all their entries, then other entries. If no part
/// has that name, the entries whose tables have a row for it, reduced to that row. Empty if there are none.
std::vector<PagePart> find_parts(const std::vector<PagePart>& parts, const std::string& name);

/// The fields and arguments that have a row in a table of these parts.
std::vector<std::string> row_names(const std::vector<PagePart>& parts);

/// The part as plain text of at most 80 columns (unless a word is longer): without pictures, links and quotes, with
/// tables as lists.
std::string plain_text(const PagePart& part);

}  // namespace deburr
