// What a mesh loses in a file of single precision, as STL and GLB are.
#pragma once
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

struct SinglePrecisionLoss {
    double step = 0;          // between numbers next to each other, at the largest coordinate
    double coordinate = 0;    // that one
    double min_edge = 0;      // of the mesh; 0 if it is empty
    std::size_t spoiled = 0;  // facets that are flattened or turned over
};

SinglePrecisionLoss single_precision_loss(const Mesh& mesh);

/// Outward unit normal of the triangle that these corners make; 0 where they make none.
Vec3 single_precision_normal(const Mesh& mesh, const Triangle& t);

}  // namespace deburr
