#include "raytracer/util/scene_error.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "raytracer/util/printable.hpp"

namespace deburr {

std::string one_line(const std::string& message, const SourceMap& sources) {
    constexpr std::size_t longest = 600;
    const char mark[] = {file_mark, ':', 0};
    const std::string_view rest = message;
    const std::string file = sources.place(0);
    std::string line;
    if (rest.substr(0, 2) != mark) line = file + ": ";
    for (std::size_t at = 0; at < rest.size() && line.size() <= file.size() + longest;) {
        if (rest.substr(at, 2) == mark) {
            int number = 0;
            const char* const digits = rest.data() + at + 2;
            const char* const end = std::from_chars(digits, rest.data() + rest.size(), number).ptr;
            line += sources.place(number);
            at += end == digits ? 1 : std::size_t(2 + (end - digits));
        }
        const std::size_t end = std::min(rest.find(mark, at), rest.size());
        line += printable(shortened(rest.substr(at, end - at), longest));
        at = end;
    }
    return shortened(line, file.size() + longest);
}

}  // namespace deburr
