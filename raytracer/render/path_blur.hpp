// How sharp the layers are that a path meets: by what it has met before, and of roughness from a texture.
#pragma once
#include <iterator>

namespace deburr {

// Least α of layers that a path meets, by how blurred it is: 0 from the camera; the last from a diffuse surface, where
// few paths find a sharp highlight, and those are bright; between them from rough layers, whose reflection is
// blurred already, so that one sharper than twice their α hardly looks different.
inline constexpr double blur_alphas[] = {0, 0.0625, 0.125, 0.25, 0.5};
inline constexpr int blurs = int(std::size(blur_alphas));
inline constexpr double blur_in_blur = 2.0;

inline int blur_after(double alpha) {
    int blur = 0;
    while (blur < blurs - 1 && blur_alphas[blur] < blur_in_blur * alpha) ++blur;
    return blur;
}

// Roughness from a texture is one of so many steps above 0 or the next, as often as it is near it: the mean of the two
// lobes has the width between.
inline constexpr int roughness_steps = 16;

}  // namespace deburr
