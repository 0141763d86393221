// Boxes as text for messages.
#pragma once
#include <string>

#include "bounds/vec.hpp"

namespace deburr {

/// The box as text: "[0, 3] x [0, 1] x [0, 1]", "[0, 1]³" or "empty". Sides are rounded to remove the slack by which
/// boxes are larger than their content.
std::string box_text(const Box& box);

}  // namespace deburr
