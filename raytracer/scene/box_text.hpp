// Boxes in words.
#pragma once
#include <string>

#include "bounds/vec.hpp"

namespace deburr {

/// "[0, 3] x [0, 1] x [0, 1]", "[0, 1]³" or "empty", without the hair by which boxes are larger than what they hold for
/// certain.
std::string box_text(const Box& box);

}  // namespace deburr
