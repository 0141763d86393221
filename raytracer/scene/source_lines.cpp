#include "raytracer/scene/source_lines.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

namespace deburr {
namespace {

struct Token {
    std::string_view text;  // a name, or a single other character
    int line;
};

// Splits Lua text into tokens, as far as needed to skip comments and strings.
class Lexer {
public:
    explicit Lexer(std::string_view text) : text_(text) {}

    std::vector<Token> tokens() {
        std::vector<Token> found;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (starts("--")) {
                at_ += 2;
                if (!long_bracket()) at_ = std::min(text_.find('\n', at_), text_.size());
            } else if (c == '"' || c == '\'') {
                quoted(c);
            } else if (c == '[' && long_bracket()) {
                continue;
            } else if (is_name(c)) {
                const std::size_t start = at_;
                while (at_ < text_.size() && is_name(text_[at_])) ++at_;
                found.push_back({text_.substr(start, at_ - start), line_});
            } else {
                if (!std::isspace(static_cast<unsigned char>(c))) found.push_back({text_.substr(at_, 1), line_});
                step();
            }
        }
        return found;
    }

private:
    static bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
    bool starts(std::string_view s) const { return text_.compare(at_, s.size(), s) == 0; }

    void step() {
        if (at_ >= text_.size()) return;
        if (text_[at_] == '\n') ++line_;
        ++at_;
    }

    void quoted(char quote) {
        for (step(); at_ < text_.size() && text_[at_] != quote; step())
            if (text_[at_] == '\\') step();
        step();
    }

    // Skips [[ … ]] or [==[ … ]==]; false if there is none here.
    bool long_bracket() {
        if (!starts("[")) return false;
        std::size_t level = at_ + 1;
        while (level < text_.size() && text_[level] == '=') ++level;
        if (level >= text_.size() || text_[level] != '[') return false;
        std::string close(level - at_ + 1, '=');
        close.front() = close.back() = ']';
        const std::size_t end = std::min(text_.find(close, level + 1), text_.size());
        while (at_ < std::min(end + close.size(), text_.size())) step();
        return true;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
};

int only_assignment(const std::vector<Token>& tokens, const std::string& name) {
    int line = 0;
    for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
        if (tokens[i].text != name || tokens[i + 1].text != "=") continue;
        if (i + 2 < tokens.size() && tokens[i + 2].text == "=") continue;  // it is a comparison
        if (line > 0) return 0;
        line = tokens[i].line;
    }
    return line;
}

}  // namespace

int line_of(const std::string& text, const std::string& location) {
    const std::vector<Token> tokens = Lexer(text).tokens();
    std::string path = location;
    while (!path.empty()) {
        const std::size_t dot = path.rfind('.');
        std::string name = dot == std::string::npos ? path : path.substr(dot + 1);
        name = name.substr(0, name.find('['));
        if (const int line = only_assignment(tokens, name)) return line;
        path = dot == std::string::npos ? "" : path.substr(0, dot);
    }
    for (auto token = tokens.rbegin(); token != tokens.rend(); ++token)
        if (token->text == "return") return token->line;
    return 0;
}

}  // namespace deburr
