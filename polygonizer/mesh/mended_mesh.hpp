// A mesh after its last repair, and what is wrong with it still.
#pragma once
#include <limits>
#include <utility>
#include <vector>

#include "polygonizer/mesh/facets.hpp"

namespace deburr {

struct MendedMesh {
    Mesh mesh;
    std::vector<Origin> origins;
    std::vector<int> wrong;  // triangles that lean, cross others, or are too far from the surface
    std::size_t leaning = std::numeric_limits<std::size_t>::max();  // facets that lean or face inward
    std::size_t others = std::numeric_limits<std::size_t>::max();   // facets that are too far, and pairs that cross
    bool crosses = false;                                           // whether any do
    double farthest = 0;                                            // middle of a facet from the surface

    bool is_right() const { return leaning == 0 && others == 0; }
    /// Facets that lean or face inward are the graver fault.
    bool is_better_than(const MendedMesh& other) const {
        return std::pair(leaning, others) < std::pair(other.leaning, other.others);
    }
};

}  // namespace deburr
