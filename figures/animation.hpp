// A sequence of pictures as one file: an animated PNG [PNG Specification, 3rd edition, §11.3.6].
#pragma once
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"

namespace deburr {

/// The bytes of the file; frames have one size. Shows each for `seconds`, the last one for a second,
/// and starts over.
std::string animated_png(const std::vector<Film>& frames, double seconds);

}  // namespace deburr
