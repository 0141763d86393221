// OpenSCAD's models, through the program `openscad`, any version.
#pragma once
#include <string>

namespace deburr {

/// The STL that `openscad` makes of a .scad or .csg. What the program says while it works goes to stderr where it says
/// WARNING or ERROR. Throws UnsupportedError where the program is not installed, and SceneError, with its own words,
/// where it fails.
std::string openscad_output(const std::string& path);

}  // namespace deburr
