// Camera matrices for an EXR's header, as OpenEXR's standard attributes define them: they multiply row vectors from the
// right, (x y z 1)·M.
#pragma once
#include <array>

#include "raytracer/scene/scene.hpp"

namespace deburr {

using Matrix44 = std::array<std::array<float, 4>, 4>;  // row by row

/// World to camera: left-handed, with x to the right, y up and z in the viewing direction.
Matrix44 world_to_camera(const Camera& camera);

/// World to the display window: after division by w, (0, 0) is its upper left corner and (1, 1) the lower right one.
/// z/w only orders by nearness: it is 1 over the distance along the axis, or that distance for an orthographic camera.
Matrix44 world_to_ndc(const Camera& camera, int width, int height);

}  // namespace deburr
