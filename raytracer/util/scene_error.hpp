// Error messages about a scene's or a model's file: one line that begins with the file's name.
#pragma once
#include <stdexcept>
#include <string>

#include "raytracer/util/source_map.hpp"

namespace deburr {

/// An error in a scene. what() is one line that begins with the file's name and, where known, the line.
class SceneError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Stands for the file's name while a message is put together by functions that would cut off long names.
constexpr char file_mark = '\1';

/// The message as one printable line. A mark followed by ":LINE" becomes the place of that line in the sources, any
/// other mark the first file's name. A message that does not begin with a mark gets the first file's name in front.
std::string one_line(const std::string& message, const SourceMap& sources);
inline std::string one_line(const std::string& message, const std::string& file) {
    return one_line(message, SourceMap(file));
}

}  // namespace deburr
