// Exact predicates: on which side of a line, or of a plane, a point lies, however near it is.
//
// The determinants are evaluated in doubles first, with a bound of the rounding error; only where that leaves the sign
// open are they summed without rounding, as expansions: sums of doubles that do not overlap [Dekker 1971; Knuth, The
// Art of Computer Programming 2, §4.2.2; Priest 1991].
//
// Not promised where products of coordinates underflow, as for coordinates that differ by less than 10⁻¹⁰⁰.
#pragma once
#include "bounds/vec.hpp"

namespace deburr {

/// Twice the signed area of the triangle abc, > 0 where it is counter-clockwise. Its sign, or that it is 0, is exact.
double orientation(Vec2 a, Vec2 b, Vec2 c);

/// Six times the signed volume of the tetrahedron abcd, > 0 where abc is counter-clockwise seen from d. Its sign, or
/// that it is 0, is exact.
double orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

}  // namespace deburr
