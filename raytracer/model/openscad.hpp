// Converts OpenSCAD programs to meshes by the program `openscad`, any version.
#pragma once
#include <string>

namespace deburr {

/// The STL that `openscad` makes of a .scad or .csg file. Its lines with WARNING or ERROR are copied to stderr. Throws
/// UnsupportedError if `openscad` is not installed, SceneError with its messages if it fails, and WorkError if it
/// cannot be started.
std::string openscad_output(const std::string& path);

}  // namespace deburr
