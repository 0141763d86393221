// Meshes of a scene's solids, by any method.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "polygonizer/mesh/mesh_check.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/mesh/mesh_settings.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The meshes of a scene and how they were made. Vectors are indexed by solid unless noted.
struct SceneMesh {
    Mesh mesh;  // all parts together; see join_parts()
    std::vector<Mesh> parts;
    Box near;                         // around the finite solids; infinite ones are cut off far from it
    std::vector<SolidTree> trees;     // the solids that were meshed, cut off if infinite
    std::vector<MeshMethod> methods;  // methods that were used, each once; not by solid
    TriageStatistics triage;          // sums
    OctreeStatistics octree;          // sums; of edges the least, of levels the highest
    std::vector<MeshCheck> checks;    // empty unless they were asked for
    std::vector<MeshCheckOptions> check_options;
    std::vector<char> wanted;        // whether the solid was to have a mesh
    std::vector<double> tolerances;  // that the meshes were made to; infinity: none
    std::size_t made_again = 0;      // number of solids that failed the check and were made finer
    std::vector<std::string> warnings;

    std::string method_names() const;  // such as "octree, triage"
};

/// Callbacks for meshing.
struct MeshWatch {
    CancelFlag cancel = nullptr;            // once it is set, Cancelled is thrown soon
    std::function<void(double)> done = {};  // told the share of work since its last call, by any thread
};

/// Meshes the solids, in parallel; the result does not depend on that. Infinite solids are left out if the settings say
/// so, and else cut off at a distance that keeps the others in view; a warning says so. Throws UnsupportedError if a
/// grid would be too fine or if all solids are left out, and Cancelled.
SceneMesh mesh_scene(const Scene& scene, const MeshSettings& settings, const MeshWatch& watch = {});

/// mesh_scene() without the last step: `mesh` stays empty until join_parts() is called.
SceneMesh mesh_parts(const Scene& scene, const MeshSettings& settings, const MeshWatch& watch = {});

/// Puts the parts together in `mesh`. Parts that touch are moved apart by a least separation, in `parts`, too.
void join_parts(SceneMesh& mesh);

/// The metrics of each part.
std::vector<MeshMetrics> measure_parts(const SceneMesh& mesh);

}  // namespace deburr
