// Loads the pictures that surround a scene or lie on its surfaces.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Reads the pictures named by the scene's backgrounds and textures; pictures with the same use are read once. Colours
/// in display formats are decoded from sRGB; factors and heights are the numbers in the file. The `a` of an image
/// texture becomes its mean, as does the number that it replaces. Throws UsageError if a picture cannot be read, has a
/// background value that is negative or not finite, or has a value that its texture's use does not allow.
void load_pictures(Scene& scene);
/// As load_pictures(), for the textures only.
void load_textures(Scene& scene);

}  // namespace deburr
