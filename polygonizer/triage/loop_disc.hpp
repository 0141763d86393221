// Discs that span a loop on the isosurface within one cell [Triage §4.4.4, §4.5.2].
#pragma once
#include <vector>

#include "bounds/local_density.hpp"
#include "polygonizer/triage/cell_complex.hpp"

namespace deburr {

/// Of the length of what is taken for flat, how far the surface may be from its middle: it leans by 11° then.
constexpr double max_sag = 0.05;

struct Disc {
    std::vector<CellComplex::VertexList> faces;  // positions in the rim; its size: the centre
    bool has_center = false;
    Vec3 center{0.0};
};

/// `rim` lies on the isosurface, counter-clockwise seen from inside (ρ > ½); at least 3 points.
/// `walls` are the planes of the cell, (n, d) with n·x ≤ d within: the centre stays between them. A disc whose rim and
/// middle are nearer to one plane than `slack`, and max_sag of its size, is flat.
struct Wall {
    Vec3 normal;
    double offset;
};
void span_loop(const std::vector<Vec3>& rim, const LocalDensity& density, const std::vector<Wall>& walls,
               double tolerance, double slack, Disc& disc);

}  // namespace deburr
