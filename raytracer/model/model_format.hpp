// Which format a model's file has, and whether what it claims of itself is true.
#pragma once
#include <string>

namespace deburr {

/// Whether a path names a model rather than a scene: by its extension, in any case of letters.
bool is_model_path(const std::string& path);
/// Whether it names a program for OpenSCAD: .scad or .csg.
bool is_openscad_path(const std::string& path);

/// The format's name as ModelReader takes it, told by the first bytes, or by the extension where a format has no sign
/// of its own. Throws SceneError, which names `path`, where the file is none that is read, or is cut off.
std::string model_format(const std::string& bytes, const std::string& path);

}  // namespace deburr
