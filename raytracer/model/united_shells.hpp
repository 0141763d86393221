// Unites shells that overlap, or one that passes through itself: the result is the boundary of all points with a
// winding number of at least one.
//
// Triangles are cut where they meet others, and a part is kept if the surface winds around exactly one of its sides
// [Zhou, Grinspun, Zorin & Jacobson 2016, Mesh arrangements for solid geometry]. All decisions are made in rational
// numbers; only the new vertices are rounded, at the end.
#pragma once
#include <array>
#include <stdexcept>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// The surface has places with a negative winding number, where the solid is undefined.
struct InsideOut : std::runtime_error {
    InsideOut(std::size_t how_many, Vec3 where) : std::runtime_error("inside out"), count(how_many), place(where) {}
    std::size_t count;  // number of parts of facets next to such a place
    Vec3 place;         // a point of the first one
};

/// The result of united_shells().
struct UnitedShells {
    std::vector<Vec3> vertices;
    std::vector<std::array<int, 3>> triangles;
};

/// Unites the shells of a surface, which must be closed, without equal vertices and without triangles of no area. If
/// there are places with a negative winding number, throws InsideOut if `strict`, and leaves them out otherwise.
UnitedShells united_shells(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles,
                           bool strict = true);

}  // namespace deburr
