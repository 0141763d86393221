#include "raytracer/cli/scene_page.hpp"

#include <algorithm>
#include <cctype>

namespace deburr {
namespace {

constexpr std::size_t width = 80;

std::string lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool starts(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(' ');
    if (first == text.npos) return "";
    return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

// The name in a heading: "rounded" of "rounded(radius, density)", "translate" of "x:translate(…)", "|" of "a | b", "~"
// of "~a".
std::string entry_name(const std::string& heading) {
    const std::size_t call = heading.find_first_of("({");
    if (call != std::string::npos) {
        const std::string name = heading.substr(0, call);
        return name.substr(name.find(':') + 1);
    }
    if (heading.find_first_of("|&~+-*") == std::string::npos) return heading;
    std::string name;
    for (const char c : heading)
        if (std::ispunct(static_cast<unsigned char>(c))) name += c;
    return name;
}

std::string singular(const std::string& name) {
    if (name.ends_with("ies")) return name.substr(0, name.size() - 3) + "y";
    return name.ends_with("s") ? name.substr(0, name.size() - 1) : name;
}

std::vector<std::string> names_of(const std::string& heading, int level) {
    const std::string name = lower(level == 3 ? entry_name(heading) : heading);
    std::vector<std::string> names{name};
    if (level == 1) {
        std::string rest = name;
        for (std::size_t blank; (blank = rest.find(' ')) != std::string::npos; rest.erase(0, blank + 1))
            names.push_back(rest.substr(0, blank));
        names.push_back(rest);
    } else if (level == 2 && singular(name) != name) {
        names.push_back(singular(name));
    }
    return names;
}

// The cells of a table's row; empty if the line is none.
std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    if (!starts(line, "|")) return cells;
    bool code = false;
    std::string cell;
    for (const char c : line.substr(1)) {
        if (c == '`') code = !code;
        if (c == '|' && !code) {
            cells.push_back(trimmed(cell));
            cell.clear();
        } else {
            cell += c;
        }
    }
    return cells;
}

// The text without code quotes, links and asterisks.
std::string plain(const std::string& text) {
    std::string out;
    bool code = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '`') {
            code = !code;
        } else if (!code && c == ']' && i + 1 < text.size() && text[i + 1] == '(') {
            i = std::min(text.find(')', i), text.size());
        } else if (!code && (c == '[' ? text.find("](", i) < text.find(' ', text.find(']', i)) : c == '*')) {
            continue;
        } else {
            out += c;
        }
    }
    return out;
}

std::size_t columns(const std::string& text) {  // counts code points
    return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

// Appends the text wrapped to the page's width. `first` begins the first line; further lines are indented as far.
void wrap(std::string& out, const std::string& first, const std::string& text) {
    const std::string indent(columns(first), ' ');
    std::string line = first, word;
    bool empty = true;
    const auto end_word = [&] {
        if (word.empty()) return;
        if (!empty && columns(line) + 1 + columns(word) > width) {
            out += line + "\n";
            line = indent;
            empty = true;
        }
        if (!empty) line += ' ';
        line += word;
        empty = false;
        word.clear();
    };
    for (const char c : text) {
        if (c == ' ')
            end_word();
        else
            word += c;
    }
    end_word();
    out += line + "\n";
}

// Converts the Markdown of a part (paragraphs, lists, code, tables) to plain text.
class PlainText {
public:
    explicit PlainText(const std::string& markdown) {
        for (const std::string& line : lines_of(markdown)) add(line);
        end_paragraph();
    }
    std::string text;

private:
    void add(const std::string& line) {
        if (starts(line, "```")) {
            end_paragraph();
            code_ = !code_;
            if (!code_) text += "\n";
        } else if (code_) {
            text += "    " + line + "\n";
        } else if (!cells_of(line).empty()) {
            end_paragraph();
            add_row(cells_of(line));
        } else {
            if (in_table_) text += in_list_ ? "\n" : "";
            in_table_ = false;
            if (line.empty() || starts(line, "![")) return end_paragraph();
            if (starts(line, "- ")) end_item();
            if (!paragraph_.empty()) paragraph_ += ' ';
            paragraph_ += trimmed(line);
        }
    }

    // Appends a row of a table of fields or arguments as "name  takes; default: this. Meaning.". Other tables contain
    // pictures, and are dropped.
    void add_row(const std::vector<std::string>& cells) {
        if (!in_table_) {
            header_ = cells;
            in_table_ = true;
            in_list_ = cells[0] == "field" || cells[0] == "argument";
            return;
        }
        if (!in_list_ || cells.size() != header_.size() || starts(cells[0], "--")) return;
        std::string words;
        for (std::size_t i = 1; i < cells.size(); ++i) {
            if (header_[i] == "default") words += cells[i] == "required" ? "; required" : "; default: " + cells[i];
            if (header_[i] == "takes") words += cells[i];
            if (header_[i] == "meaning") words += ". " + meaning(cells[i]);
        }
        std::string first = plain(cells[0]);
        first.insert(0, 2, ' ').append(2, ' ');
        while (columns(first) < 16) first += ' ';
        wrap(text, first, plain(words));
    }

    static std::string meaning(std::string cell) {
        if (!cell.empty()) cell[0] = char(std::toupper(static_cast<unsigned char>(cell[0])));
        return cell + ".";
    }

    void end_item() {
        if (paragraph_.empty()) return;
        const bool item = starts(paragraph_, "- ");
        wrap(text, item ? "- " : "", plain(item ? paragraph_.substr(2) : paragraph_));
        paragraph_.clear();
    }

    void end_paragraph() {
        if (paragraph_.empty()) return;
        end_item();
        text += "\n";
    }

    std::string paragraph_;
    std::vector<std::string> header_;
    bool code_ = false, in_table_ = false, in_list_ = false;
};

// The table of the part's text that has a row for `name`, with that row only; "" if there is none.
std::string row_of(const PagePart& part, const std::string& name) {
    std::string header, rule;
    for (const std::string& line : lines_of(part.text)) {
        const std::vector<std::string> cells = cells_of(line);
        if (cells.empty()) {
            header.clear();
            rule.clear();
        } else if (header.empty()) {
            header = line;
        } else if (rule.empty()) {
            rule = line;
        } else if (lower(plain(cells[0])) == name) {
            return header + "\n" + rule + "\n" + line + "\n";
        }
    }
    return "";
}

}  // namespace

std::vector<PagePart> parts_of_page(std::string_view page) {
    std::vector<PagePart> parts;
    bool code = false;
    for (const std::string& line : lines_of(page)) {
        if (starts(line, "```")) code = !code;
        const std::size_t marks = code ? 0 : line.find_first_not_of('#');
        if (marks > 0 && marks <= 3 && line[marks] == ' ') {
            const std::string heading = line.substr(marks + 1);
            parts.push_back({int(marks), heading, "", names_of(heading, int(marks))});
        } else if (!parts.empty()) {
            parts.back().text += line + "\n";
        }
    }
    return parts;
}

std::vector<PagePart> find_parts(const std::vector<PagePart>& parts, const std::string& given) {
    const std::string name = lower(given.size() > 1 && given[0] == ':' ? given.substr(1) : given);
    const auto is_called = [&](const PagePart& part) {
        return std::find(part.names.begin(), part.names.end(), name) != part.names.end();
    };
    std::vector<PagePart> topics, entries, rows;
    bool in_topic = false;
    for (const PagePart& part : parts) {
        if (part.level < 3) in_topic = is_called(part);
        if (in_topic)
            topics.push_back(part);
        else if (is_called(part))
            entries.push_back(part);
        else if (const std::string row = row_of(part, name); !row.empty())
            rows.push_back({part.level, part.heading, row, {name}});
    }
    topics.insert(topics.end(), entries.begin(), entries.end());
    return topics.empty() ? rows : topics;
}

std::vector<std::string> row_names(const std::vector<PagePart>& parts) {
    std::vector<std::string> names;
    for (const PagePart& part : parts)
        for (const std::string& line : lines_of(part.text))
            if (const std::vector<std::string> cells = cells_of(line); !cells.empty() && starts(cells[0], "`"))
                names.push_back(plain(cells[0]));
    return names;
}

std::string plain_text(const PagePart& part) {
    const std::string heading = part.heading;
    std::string text = heading + "\n" + std::string(columns(heading), part.level < 3 ? '=' : '-') + "\n";
    text += PlainText(part.text).text;
    while (text.ends_with("\n\n")) text.pop_back();
    return text;
}

}  // namespace deburr
