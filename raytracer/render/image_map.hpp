// Pictures on surfaces without coordinates of their own: laid on from three sides, as light falls through a box's
// walls.
//
// A face that looks along an axis shows the picture that lies across that axis, upright and readable from outside. What
// looks between the axes shows a blend of two or three. The picture repeats without end.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The picture's value at `position` on a surface whose unit normal points out of the solid, between the centres of
/// four of its pixels; texture.a where no picture was read.
Vec3 image_color(const Texture& texture, Vec3 position, Vec3 normal);

}  // namespace deburr
