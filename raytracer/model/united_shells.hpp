// The union of shells that overlap, or of a shell that passes through itself: the boundary of all points around which
// the surface winds at least once.
//
// Triangles are cut where they meet others, and each part is kept if the surface winds around one of its sides and not
// around the other [Zhou, Grinspun, Zorin & Jacobson 2016, Mesh arrangements for solid geometry]. All is decided in
// rational numbers; only the vertices that are made are rounded in the end.
#pragma once
#include <array>
#include <stdexcept>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// Thrown where a surface winds around some places less than no times: what is meant there is not known.
struct InsideOut : std::runtime_error {
    InsideOut(std::size_t how_many, Vec3 where) : std::runtime_error("inside out"), count(how_many), place(where) {}
    std::size_t count;  // of parts of facets next to such a place
    Vec3 place;
};

struct UnitedShells {
    std::vector<Vec3> vertices;
    std::vector<std::array<int, 3>> triangles;
};

/// The surface must be closed, no two vertices equal, and no triangle without area. `strict`: throws InsideOut; else
/// what is inside out is left out.
UnitedShells united_shells(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles,
                           bool strict = true);

}  // namespace deburr
