// Bump mapping: a surface is shaded as if it were higher where a texture is brighter [Blinn, Simulation of Wrinkled
// Surfaces, 1978]. Its shape, outline and shadow do not change.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The unit normal of the surface that is displaced from `position` by texture · height along `normal`, which is unit
/// and points out of the solid. Slopes are differences over a step that suits the texture: a pixel of an image, 1/64 of
/// a pattern's scale. `height` is a scene length.
Vec3 bumped_normal(const Texture& texture, double height, Vec3 position, Vec3 normal);

/// The bumped normal, bent towards the surface's own just enough that the eye's mirror direction leads away from the
/// surface [Keller et al., The Iray Light Transport Simulation and Rendering System, 2017, A.3]. All vectors are unit;
/// `normal` and `to_eye` are on the same side of the surface.
Vec3 visible_bump(Vec3 bumped, Vec3 normal, Vec3 to_eye);

/// Both steps: the shading normal, out of the solid; `normal` itself if the material has no bump.
Vec3 shading_normal(const Material& material, Vec3 position, Vec3 normal, Vec3 to_eye);

}  // namespace deburr
