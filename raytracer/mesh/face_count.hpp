// A mesh of a wanted number of triangles.
//
// By default a mesh that keeps its tolerance is thinned out by edge collapses until it has no more, at larger and
// larger distances; where it has fewer, it is made again at half the tolerance first, as often as it takes. The octree
// and marching cubes, if they are asked for, keep their even cells: larger or smaller ones are searched for.
#pragma once
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {

/// At most `faces` triangles, and as near to that as may be; warnings say where more are left, where a tenth fewer are
/// all that there is to have, and where the mesh is farther from the surface than its tolerance.
SceneMesh mesh_scene_with_faces(const Scene& scene, MeshSettings settings, std::size_t faces,
                                CancelFlag cancel = nullptr);

}  // namespace deburr
