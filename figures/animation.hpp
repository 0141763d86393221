// Animated PNG files [PNG Specification, 3rd edition, §11.3.6].
#pragma once
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"

namespace deburr {

/// The bytes of an animated PNG of frames of one size. Each is shown for `seconds`, the last one for a second; then it
/// repeats.
std::string animated_png(const std::vector<Film>& frames, double seconds);

}  // namespace deburr
