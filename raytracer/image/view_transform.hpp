// From scene-linear light to what a display shows: only in files for the screen, never in an EXR.
#pragma once
#include <string_view>

#include "raytracer/image/film.hpp"

namespace deburr {

enum class ViewTransform {
    standard,  // as it is; what exceeds 1 is clipped
    agx,       // a soft curve that lets bright colours go to white, as film does [Sobotka, AgX, 2022]
};

/// Linear Rec. 709 from 0 to 1.
Vec3 displayed(ViewTransform view, Vec3 light);

/// The same of every pixel; colours are weighed by alpha where `alpha` says so.
Film displayed(ViewTransform view, Film film, bool alpha);

}  // namespace deburr
