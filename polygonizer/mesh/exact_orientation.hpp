// On which side of a line, or of a plane, a point lies: exactly, however near it is.
//
// The determinants are evaluated in doubles first, whose rounding is bounded; only where that leaves the sign
// open are they summed without rounding, as expansions: sums of doubles of which none overlaps another
// [Dekker 1971; Knuth, The Art of Computer Programming 2, §4.2.2; Priest 1991].
//
// Not promised where products of coordinates underflow: coordinates that differ by less than 10⁻¹⁰⁰.
#pragma once
#include "bounds/vec.hpp"

namespace deburr {

/// Twice the area of the triangle abc, > 0 where it is counter-clockwise; the sign, and 0, are exact.
double orientation(Vec2 a, Vec2 b, Vec2 c);

/// Six times the volume of the tetrahedron abcd, > 0 where abc is counter-clockwise seen from d; the sign, and
/// 0, are exact.
double orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

}  // namespace deburr
