// A mesh after its last repair, and the faults that are left.
#pragma once
#include <limits>
#include <utility>
#include <vector>

#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// A repaired mesh and its remaining faults; counts are at their maximum until it has been judged.
struct MendedMesh {
    Mesh mesh;
    /// One for each triangle.
    std::vector<Origin> origins;
    std::vector<int> wrong;  // triangles that lean, cross others, or are too far from the surface
    std::size_t leaning = std::numeric_limits<std::size_t>::max();  // facets that lean or face inward
    // facets that are too far from the surface, plus pairs that cross
    std::size_t others = std::numeric_limits<std::size_t>::max();
    bool crosses = false;  // whether any facets cross
    double farthest = 0;   // greatest distance of a facet's middle from the surface

    bool is_right() const { return leaning == 0 && others == 0; }
    /// Fewer facets that lean or face inward count for more than fewer other faults.
    bool is_better_than(const MendedMesh& other) const {
        return std::pair(leaning, others) < std::pair(other.leaning, other.others);
    }
};

}  // namespace deburr
