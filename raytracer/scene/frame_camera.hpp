// Places a camera so that the bounded solids fill the picture, whatever their size.
#pragma once
#include <optional>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The unit vector that points up: z or y.
Vec3 up_axis(bool z_up);

/// The framing of scenes that give none: a three-quarter view from the front, the right and above.
Framing default_framing(bool z_up);

/// The camera that sees all bounded solids whole and as large as possible in a picture with this ratio of width to
/// height, less a margin on each side. Unbounded solids, such as floors, and empty ones are ignored; none if no other
/// is left.
std::optional<Camera> framed_camera(const std::vector<Solid>& solids, const Framing& framing, Vec3 up, double aspect);

/// Places the scene's camera by its framing, if it has one, for a picture with this ratio of width to height, and aims
/// the default light. False if no solid is bounded; then the camera stays.
bool frame_camera(Scene& scene, double aspect);

}  // namespace deburr
