// Measures what a mesh loses in a file of single precision, such as STL and GLB.
#pragma once
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// What rounding to single precision does to a mesh.
struct SinglePrecisionLoss {
    double step = 0;          // spacing of single precision numbers at the largest coordinate
    double coordinate = 0;    // the largest absolute coordinate
    double min_edge = 0;      // shortest edge of the mesh; 0 if it is empty
    std::size_t spoiled = 0;  // facets that rounding flattens or turns over
};

/// Measures the loss; the mesh itself stays as it is.
SinglePrecisionLoss single_precision_loss(const Mesh& mesh);

/// Outward unit normal of the triangle with its corners rounded to single precision; 0 if it has no area then.
Vec3 single_precision_normal(const Mesh& mesh, const Triangle& t);

}  // namespace deburr
