// A mesh of several solids as objects one after the other, for file formats that number each object's vertices
// separately.
#pragma once
#include <array>
#include <vector>

#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// A run of triangles [begin, end) of the mesh that all belong to one solid, with vertices numbered within the object.
struct MeshObject {
    std::size_t begin = 0, end = 0;
    std::vector<int> positions;                 // indices in Mesh::positions, in the order of first use
    std::vector<std::array<int, 3>> triangles;  // indices in `positions`
};

/// Calls take(MeshObject) for each maximal run of triangles of one solid. A solid whose triangles are not consecutive
/// becomes several objects.
template <class Take>
void for_each_object(const Mesh& mesh, Take take) {
    std::vector<int> number(mesh.positions.size(), -1);
    for (std::size_t begin = 0; begin < mesh.triangles.size();) {
        MeshObject object;
        object.begin = object.end = begin;
        for (; object.end < mesh.triangles.size() && mesh.triangles[object.end].solid == mesh.triangles[begin].solid;
             ++object.end) {
            std::array<int, 3>& corners = object.triangles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const int v = mesh.triangles[object.end].vertex[k];
                if (number[v] < 0) {
                    number[v] = int(object.positions.size());
                    object.positions.push_back(v);
                }
                corners[k] = number[v];
            }
        }
        take(object);
        for (const int v : object.positions) number[v] = -1;
        begin = object.end;
    }
}

}  // namespace deburr
