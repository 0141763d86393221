// View transforms: from scene-linear light to what a display shows. They apply to files for the screen, never to an
// EXR.
#pragma once
#include <string_view>

#include "raytracer/image/film.hpp"

namespace deburr {

/// The available transforms.
enum class ViewTransform {
    standard,  // the light as it is; values above 1 are clipped
    agx,       // a soft curve that lets bright colours fade to white, as film does [Sobotka, AgX, 2022]
};

/// The displayed light for one pixel, as linear Rec. 709 from 0 to 1.
Vec3 displayed(ViewTransform view, Vec3 light);

/// The displayed light of a whole film; with `alpha`, colours are premultiplied and are divided by alpha for the
/// transform.
Film displayed(ViewTransform view, Film film, bool alpha);

}  // namespace deburr
