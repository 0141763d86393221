// Recognizes the format of a model's file, and checks that the sizes it claims are possible.
#pragma once
#include <string>

namespace deburr {

/// Throws SceneError, whose message is one line: the path, and `what` was expected and found.
[[noreturn]] void refuse_model(const std::string& path, const std::string& what);

/// Whether the path's extension, in any case, is that of a model and not of a scene.
bool is_model_path(const std::string& path);
/// Whether the path is an OpenSCAD program: .scad or .csg.
bool is_openscad_path(const std::string& path);

/// Brings STL text to the form that ModelReader knows: keywords in lower case, and nothing before the first. Other
/// bytes stay as they are.
void fold_stl_text(std::string& bytes);

/// The format's name for ModelReader, recognized by the first bytes, or by the extension where a format has no
/// signature. Throws SceneError, which names `path`, if the file has no known format or is cut off.
std::string model_format(const std::string& bytes, const std::string& path);

}  // namespace deburr
