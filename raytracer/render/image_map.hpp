// Triplanar mapping: images on surfaces without texture coordinates, projected along the three axes.
//
// A face perpendicular to an axis shows the image in that plane, upright and readable from outside; other faces show a
// blend of two or three. The image repeats in both directions.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The image's value at `position` on a surface whose unit normal points out of the solid, interpolated between four
/// pixels; texture.a if no image was read.
Vec3 image_color(const Texture& texture, Vec3 position, Vec3 normal);

}  // namespace deburr
