// What `deburr mesh` did and made, in numbers: a table for people (--stats), JSON for programs (--stats-json).
#pragma once
#include "raytracer/cli/mesh_options.hpp"
#include "raytracer/cli/statistics.hpp"
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {

/// Measures the mesh, where --stats or --stats-json asks for it, and prints or writes the figures. Adds the phase
/// "measure" to the clock.
void report_statistics(const MeshCommandOptions& options, const Scene& scene, const SceneMesh& mesh, PhaseClock& clock);

}  // namespace deburr
