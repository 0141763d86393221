// Statistics of `deburr mesh`: a table (--stats) and JSON (--stats-json).
#pragma once
#include "raytracer/cli/mesh_options.hpp"
#include "raytracer/cli/statistics.hpp"
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {

/// If --stats or --stats-json is given, measures the mesh and prints or writes the statistics. Adds the phase "measure"
/// to the clock.
void report_statistics(const MeshCommandOptions& options, const Scene& scene, const SceneMesh& mesh, PhaseClock& clock);

}  // namespace deburr
