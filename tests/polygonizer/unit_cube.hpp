// The cube that many cases begin with.
#pragma once
#include "bounds/density.hpp"

namespace deburr::test {

/// The cube of side 1 whose least corner is `at`.
inline Density unit_cube(Vec3 at = Vec3(0.0)) { return Density::box(at, at + Vec3(1.0)); }

}  // namespace deburr::test
