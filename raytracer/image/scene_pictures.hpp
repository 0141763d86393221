// Pictures that surround a scene or lie on its surfaces, from files of any format that is read.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Reads the pictures that the scene's backgrounds and textures name, each once for all that use it alike. Colours of
/// formats for display are sRGB; shares and heights are the numbers that stand in the file. Throws UsageError if one
/// cannot be read, if a background holds no light that is finite and not negative, or if a texture holds what its field
/// does not take. The `a` of a texture becomes its mean, as does the number in whose place it stands.
void load_pictures(Scene& scene);
/// Reads the pictures of the textures alone.
void load_textures(Scene& scene);

}  // namespace deburr
