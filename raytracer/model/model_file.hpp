// Models from files: STL, OBJ, PLY, OFF, 3MF, GLB and glTF, and what OpenSCAD makes of .scad and .csg.
//
// Files come from anywhere, and the libraries that read them were not written to take anything: they run in a process
// of their own, with limits of memory and time that the file's size sets, and its end is one line.
#pragma once
#include <string>
#include <vector>

#include "bounds/closed_mesh.hpp"

namespace deburr {

struct Model {
    ClosedMeshPtr mesh;
    std::vector<std::string> mended;  // what was done to the file's surface, if anything
    std::string format;               // "stl"
};

/// Reads the file. Throws SceneError where it is not what it seems to be, and UnsupportedError where its surface bounds
/// no solid; both name the file in one line.
Model read_model(const std::string& path);

}  // namespace deburr
