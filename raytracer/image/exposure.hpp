// Tells whether a picture's exposure suits a screen: bright enough to be seen, and not clipped in large parts.
#pragma once
#include <optional>
#include <string>

#include "raytracer/image/film.hpp"

namespace deburr {

/// A warning of one line if at this exposure (in stops) a large part of the picture is clipped, or nearly all is black,
/// with an exposure that shows it; also if it shows a solid but is black at any exposure. Otherwise nothing.
std::optional<std::string> exposure_advice(const Film& film, double exposure);

}  // namespace deburr
