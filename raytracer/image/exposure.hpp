// Whether a picture is bright enough to be seen on a screen, and dark enough not to be clipped.
#pragma once
#include <optional>
#include <string>

#include "raytracer/image/film.hpp"

namespace deburr {

/// Returns one line where a picture of this exposure, in stops, is clipped in a large part or nearly black, with the
/// exposure that shows it, or where it is black whatever the exposure though it shows a solid; otherwise nothing.
std::optional<std::string> exposure_advice(const Film& film, double exposure);

}  // namespace deburr
