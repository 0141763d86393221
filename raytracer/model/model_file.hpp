// Reads models from files: STL, OBJ, PLY, OFF, 3MF, GLB and glTF, and the output of OpenSCAD for .scad and .csg.
//
// Files come from anywhere, and the libraries that read them do not withstand all input, so they run in a process of
// their own, with limits of memory and time that follow from the file's size. If that process fails, the error is one
// line.
#pragma once
#include <string>
#include <vector>

#include "bounds/closed_mesh.hpp"

namespace deburr {

/// A model that was read.
struct Model {
    ClosedMeshPtr mesh;
    std::vector<std::string> mended;  // repairs of the file's surface, for messages
    std::string format;               // such as "stl"
};

/// Reads a model. Throws SceneError if the file is not a valid model, and UnsupportedError if its surface does not
/// bound a solid; both messages are one line that names the file.
Model read_model(const std::string& path);

}  // namespace deburr
