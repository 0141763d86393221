// Round parts in POV-Ray's language: its own objects where they are sharp, and formulas of their coordinates.
#pragma once
#include <string>

#include "bounds/field.hpp"
#include "bounds/round_coordinate.hpp"

namespace deburr {

/// The coordinate as a formula of x, y and z.
std::string pov_coordinate(const RoundCoordinate& coordinate);

/// The sharp part u ≤ offset as an object: a sphere, a torus, or a cylinder or cone that reaches at least to the ends
/// of the finite box.
std::string pov_round_part(const RoundCoordinate& coordinate, double offset, const Box& as_far_as);

/// The object for a field that POV-Ray has one for (a quadric, a torus), inside where POV-Ray's is; "" if there is
/// none.
std::string pov_smooth(const Field& field);

}  // namespace deburr
