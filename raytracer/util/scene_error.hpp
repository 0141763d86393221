// Messages about a scene's or a model's file: one line that begins with the file's name.
#pragma once
#include <stdexcept>
#include <string>

#include "raytracer/util/source_map.hpp"

namespace deburr {

/// what() is one line that starts with the file's name and, where known, the line.
class SceneError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Stands for the file's name in messages, which would cut long names where they are put together.
constexpr char file_mark = '\1';

/// One printable line: marks become the place that the line after them is, or the first file's name; that goes first if
/// there is no mark at the beginning.
std::string one_line(const std::string& message, const SourceMap& sources);
inline std::string one_line(const std::string& message, const std::string& file) {
    return one_line(message, SourceMap(file));
}

}  // namespace deburr
