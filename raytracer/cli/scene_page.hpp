// The page docs/scenes.md, which is compiled into the program, and its parts by name.
//
// A part is a heading with the text below it: the page's own, which opens it, a topic ("Materials"), or an entry of a
// topic ("matte{…}"). `deburr help NAME` prints parts as plain text.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace deburr {

/// The whole page, in Markdown.
std::string_view scene_page();

struct PagePart {
    int level;                       // of the heading; 1: the page, 2: topic, 3: entry
    std::string heading;             // as the page has it
    std::string text;                // below the heading, up to the next one
    std::vector<std::string> names;  // "materials" and "material", "matte", "|"; of the page its heading's words
};

/// The parts of `page`, in its order.
std::vector<PagePart> parts_of_page(std::string_view page);

/// The parts called `name`, in small or capital letters: page and topics with all their entries, then other entries.
/// Where no part has that name, the entries whose tables have a row for it, with that row alone. Empty if there are
/// none.
std::vector<PagePart> find_parts(const std::vector<PagePart>& parts, const std::string& name);

/// The fields and arguments that have a row in a table of the parts.
std::vector<std::string> row_names(const std::vector<PagePart>& parts);

/// The part as text of at most 80 columns, where its words allow that: no pictures, links or quotes, tables as lists.
std::string plain_text(const PagePart& part);

}  // namespace deburr
