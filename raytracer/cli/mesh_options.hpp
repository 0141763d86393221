// The options of `deburr mesh`.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "polygonizer/mesh/export.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/mesh/mesh_settings.hpp"

namespace deburr {

/// The options as parsed.
struct MeshCommandOptions : Options {
    std::string method, tolerance, grid, edge, level, hard_angle, faces, unit, up;  // as given; "": not given
    std::vector<std::string> only;                                                  // names or numbers of solids
    bool no_check = false, force = false, recenter = false;
};

/// Adds `mesh` to the program; parsing fills `options`.
CLI::App* add_mesh_options(CLI::App& program, const std::shared_ptr<MeshCommandOptions>& options);

/// The settings for meshing that follow from the options. Throws UsageError for a wrong option and for contradictions.
MeshSettings mesh_settings(const MeshCommandOptions& options);

/// The unit of --unit; default: millimeter. Throws UsageError, also if no output stores units.
LengthUnit length_unit(const MeshCommandOptions& options);

/// The number of triangles that --faces allows; 0: any. Throws UsageError.
std::size_t max_faces(const MeshCommandOptions& options);

}  // namespace deburr
