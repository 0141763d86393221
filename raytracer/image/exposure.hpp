// Whether a picture is bright enough to be seen on a screen, and dark enough not to be clipped.
#pragma once
#include <optional>
#include <string>

#include "raytracer/image/film.hpp"

namespace deburr {

/// One line where a picture of this exposure, in stops, is clipped in a large part or nearly black, with the exposure
/// that shows it; nothing where it is neither, or black whatever the exposure.
std::optional<std::string> exposure_advice(const Film& film, double exposure);

}  // namespace deburr
