// Solid textures: colours that vary in space, so that a cut shows the inside of the material. They are evaluated at
// points, without a filter; the samples of a pixel average them.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The colour just below the surface at `position`; `normal` is unit and points out of the solid.
Vec3 pattern_color(const Texture& texture, Vec3 position, Vec3 normal);
inline Vec3 color_at(const Texture& texture, Vec3 position, Vec3 normal) {
    return texture.kind == Texture::Kind::constant ? texture.a : pattern_color(texture, position, normal);
}

/// The mean of the colour's components, for textures of numbers.
inline double value_at(const Texture& texture, Vec3 position, Vec3 normal) {
    const Vec3 c = color_at(texture, position, normal);
    return (c.x + c.y + c.z) / 3;
}

/// Gradient noise [after Perlin, Improving Noise, 2002] with a lattice of hashed gradients: smooth, 0 at integer
/// points, in [-1, 1], the same on every machine.
double noise(Vec3 x);

}  // namespace deburr
