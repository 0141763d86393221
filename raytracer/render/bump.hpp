// Bumps: a surface is shaded as if it were higher where a texture is brighter [Blinn, Simulation of Wrinkled Surfaces,
// 1978]. Its shape, its outline and its shadow stay as they are.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The unit normal of the surface that is higher than the one at `position` by texture · height along `normal`, which
/// is unit and points out of the solid. Slopes are means over a step that belongs to the texture: a pixel of an image,
/// a sixty-fourth of a pattern's scale.
Vec3 bumped_normal(const Texture& texture, double height, Vec3 position, Vec3 normal);

/// A bumped normal bent so little towards the surface's own that what it mirrors to the eye comes from outside [Keller
/// et al., The Iray Light Transport Simulation and Rendering System, 2017, A.3]. All are unit; `normal` and `to_eye`
/// are on the same side of the surface.
Vec3 visible_bump(Vec3 bumped, Vec3 normal, Vec3 to_eye);

/// Both: the normal out of the solid with which a material is shaded, `normal` itself where it has no bump.
Vec3 shading_normal(const Material& material, Vec3 position, Vec3 normal, Vec3 to_eye);

}  // namespace deburr
