// Round parts in POV-Ray's words: its own solids where they are sharp, and formulas of their coordinates.
#pragma once
#include <string>

#include "bounds/field.hpp"
#include "bounds/round_coordinate.hpp"

namespace deburr {

/// The coordinate as a formula of x, y and z.
std::string pov_coordinate(const RoundCoordinate& coordinate);

/// The sharp part u ≤ offset as an object: a sphere, a torus, or a cylinder or cone that reaches as far as the finite
/// box, at least.
std::string pov_round_part(const RoundCoordinate& coordinate, double offset, const Box& as_far_as);

/// A quadric, a torus: a field that POV-Ray has an object for; empty if there is none.
std::string pov_smooth(const Field& field);

}  // namespace deburr
