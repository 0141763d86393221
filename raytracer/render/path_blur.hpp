// Limits how sharp a path sees layers, by what it has met before; and quantizes roughness from textures.
#pragma once
#include <iterator>

namespace deburr {

// Least α of the layers that a path meets, by its blur: 0 after the camera; the last one after a diffuse surface, since
// few paths find a sharp highlight from there, and those are bright; those between after rough layers, whose reflection
// is already blurred, so that a layer with less than twice their α hardly looks different.
inline constexpr double blur_alphas[] = {0, 0.0625, 0.125, 0.25, 0.5};
inline constexpr int blurs = int(std::size(blur_alphas));
inline constexpr double blur_in_blur = 2.0;

// The blur of a path after it was scattered by a layer with this α.
inline int blur_after(double alpha) {
    int blur = 0;
    while (blur < blurs - 1 && blur_alphas[blur] < blur_in_blur * alpha) ++blur;
    return blur;
}

// Roughness from a texture is rounded at random to one of the two nearest of this many steps above 0, with
// probabilities that keep the mean; the mean of the two lobes has the width between.
inline constexpr int roughness_steps = 16;

}  // namespace deburr
