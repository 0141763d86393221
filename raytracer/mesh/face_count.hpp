// Makes a mesh with a wanted number of triangles.
//
// By default, a mesh that keeps its tolerance is thinned out by edge collapses at growing distances until it has few
// enough triangles; if it has too few, it is first made again at half the tolerance, repeatedly. The octree and
// marching cubes, if they are asked for, keep their even cells, so larger or smaller cells are searched for.
#pragma once
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {

/// A mesh of at most `faces` triangles, and as close to that as possible. Warnings say where more are left, where the
/// mesh has over a tenth fewer because there are no more to have, and where it is farther from the surface than its
/// tolerance. Throws as mesh_scene() does.
SceneMesh mesh_scene_with_faces(const Scene& scene, MeshSettings settings, std::size_t faces,
                                CancelFlag cancel = nullptr);

}  // namespace deburr
