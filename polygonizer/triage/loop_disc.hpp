// Discs that span a loop on the isosurface within one cell [Triage §4.4.4, §4.5.2].
#pragma once
#include <vector>

#include "bounds/local_density.hpp"
#include "polygonizer/triage/cell_complex.hpp"

namespace deburr {

struct Disc {
    std::vector<CellComplex::VertexList> faces;  // positions in the rim; its size: the centre
    bool has_center = false;
    Vec3 center{0.0};
};

/// `rim` lies on the isosurface, counter-clockwise seen from inside (ρ > ½); at least 3 points.
/// `walls` are the planes of the cell, (n, d) with n·x ≤ d within: the centre stays between them.
struct Wall {
    Vec3 normal;
    double offset;
};
void span_loop(const std::vector<Vec3>& rim, const LocalDensity& density, const std::vector<Wall>& walls,
               double tolerance, Disc& disc);

}  // namespace deburr
