#include "raytracer/util/scene_error.hpp"

#include <algorithm>
#include <string_view>

#include "raytracer/util/printable.hpp"

namespace deburr {

std::string one_line(const std::string& message, const std::string& file) {
    constexpr std::size_t longest = 600;
    const char mark[] = {file_mark, ':', 0};
    const std::string_view rest = message;
    std::string line;
    if (rest.substr(0, 2) != mark) line = file + ": ";
    for (std::size_t at = 0; at < rest.size() && line.size() <= file.size() + longest;) {
        const bool marked = rest.substr(at, 2) == mark;
        if (marked) line += file;
        at += marked;
        const std::size_t end = std::min(rest.find(mark, at), rest.size());
        line += printable(shortened(rest.substr(at, end - at), longest));
        at = end;
    }
    return shortened(line, file.size() + longest);
}

}  // namespace deburr
