// The interface of the module for models (util/module.hpp), which calls Assimp to read STL, OBJ, PLY, OFF, 3MF and
// glTF.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// Triangles as a file has them: not joined, checked or turned.
struct TriangleSoup {
    std::vector<Vec3> vertices;
    std::vector<std::array<int, 3>> triangles;
};

/// Reads the bytes of a file in this format (a name such as "stl"). Throws std::runtime_error with the library's
/// message.
using ModelReader = TriangleSoup(const std::string& bytes, const std::string& format);

/// The type and name of the only function that the module exports.
using ModelModuleEntry = ModelReader*();
constexpr const char* model_module_entry = "deburr_model_module";

}  // namespace deburr
