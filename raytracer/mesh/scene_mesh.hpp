// A scene's solids as meshes, by whichever method.
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

struct SceneMesh {
    Mesh mesh;                // of all solids
    std::vector<Mesh> parts;  // solid by solid
    Box near;                 // of the finite solids: infinite ones are cut off far around it
    std::vector<SolidTree> trees;
    std::vector<MeshMethod> methods;  // that were used, each once
    TriageStatistics triage;          // sums
    OctreeStatistics octree;          // sums; the least edge, the highest level
    std::vector<MeshCheck> checks;    // solid by solid, if they were asked for
    std::vector<MeshCheckOptions> check_options;
    std::vector<char> wanted;        // solid by solid: whether it was to have a mesh
    std::vector<double> tolerances;  // solid by solid, to which they were made; infinity: none
    std::size_t made_again = 0;      // solids that were made finer, for they had failed
    std::vector<std::string> warnings;

    std::string method_names() const;  // "octree, triage"
};

/// How the making of a mesh is watched.
struct MeshWatch {
    CancelFlag cancel = nullptr;            // once it is set, Cancelled is thrown soon
    std::function<void(double)> done = {};  // the share of the work that is done since the last call; any thread
};

/// Solids are polygonized in parallel; the mesh does not depend on that. Those that reach to infinity are left out, if
/// the settings say so, or cut off, at a distance that leaves the others in sight; a warning says so. Throws
/// UnsupportedError if a grid would be too fine, or if all solids are left out.
SceneMesh mesh_scene(const Scene& scene, const MeshSettings& settings, const MeshWatch& watch = {});

/// The parts alone: `mesh` is empty until join_parts().
SceneMesh mesh_parts(const Scene& scene, const MeshSettings& settings, const MeshWatch& watch = {});

/// Puts the parts together, apart by a hair where they touch.
void join_parts(SceneMesh& mesh);

std::vector<MeshMetrics> measure_parts(const SceneMesh& mesh);

}  // namespace deburr
