// The options of deburr mesh.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "polygonizer/mesh/export.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/mesh/mesh_settings.hpp"

namespace deburr {

struct MeshCommandOptions : Options {
    std::string method, tolerance, grid, edge, level, hard_angle, faces, unit, up;  // as they were given; "": not
    std::vector<std::string> only;                                                  // names or numbers of solids
    bool no_check = false, force = false, recenter = false;
};

/// Adds `mesh` to the program. The options come to life with it.
CLI::App* add_mesh_options(CLI::App& program, const std::shared_ptr<MeshCommandOptions>& options);

/// How the options say that the solids are meshed. Throws UsageError where one is wrong, or two contradict each other.
MeshSettings mesh_settings(const MeshCommandOptions& options);

/// The unit of --unit, or a millimeter. Throws UsageError, also where no output has units.
LengthUnit length_unit(const MeshCommandOptions& options);

/// The number of triangles that --faces allows; 0: any. Throws UsageError.
std::size_t max_faces(const MeshCommandOptions& options);

}  // namespace deburr
