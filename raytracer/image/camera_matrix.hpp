// The camera as other programs read it from an EXR's header: matrices that multiply row vectors
// from the right, (x y z 1)·M, as OpenEXR's standard attributes define them.
#pragma once
#include <array>

#include "raytracer/scene/scene.hpp"

namespace deburr {

using Matrix44 = std::array<std::array<float, 4>, 4>;  // row by row

/// World to camera: left-handed, x right, y up, z the way the camera looks.
Matrix44 world_to_camera(const Camera& camera);

/// World to the display window: after division by w, (0, 0) is its upper left corner and (1, 1) the
/// lower right one. z/w means nothing but nearness: 1 over the distance along the axis; of an orthographic
/// camera, that distance.
Matrix44 world_to_ndc(const Camera& camera, int width, int height);

}  // namespace deburr
