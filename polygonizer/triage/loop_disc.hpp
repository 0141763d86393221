// Discs that span a loop on the isosurface within a cell [Triage §4.4.4, §4.5.2].
#pragma once
#include <vector>

#include "bounds/local_density.hpp"
#include "polygonizer/triage/cell_complex.hpp"

namespace deburr {

/// The greatest distance of the surface from the middle of a segment or disc that is taken for flat, relative to its
/// length; the surface then leans by 11°.
constexpr double max_sag = 0.05;

/// A disc made of faces.
struct Disc {
    std::vector<CellComplex::VertexList> faces;  // indices in the rim, or its size for the centre
    bool has_center = false;
    Vec3 center{0.0};
};

/// A plane of a cell: n·x ≤ offset within the cell.
struct Wall {
    Vec3 normal;
    double offset;
};
/// Spans the loop `rim` on the isosurface, which has at least 3 points and runs counter-clockwise seen from inside
/// (ρ > ½), by a disc. A centre, if it needs one, stays between the walls of the cell. A disc whose rim and middle are
/// nearer to one plane than `slack`, and than max_sag of its size, is flat. Points within `tolerance` of a plane count
/// as on it.
void span_loop(const std::vector<Vec3>& rim, const LocalDensity& density, const std::vector<Wall>& walls,
               double tolerance, double slack, Disc& disc);

}  // namespace deburr
