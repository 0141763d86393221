// A camera that is placed by what there is to see: the bounded solids fill the picture, whatever their size.
#pragma once
#include <optional>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The direction that points up: z, or y.
Vec3 up_axis(bool z_up);

/// The framing that scenes have without a word: a three-quarter view from the front, the right and above.
Framing default_framing(bool z_up);

/// The camera that sees all bounded solids whole and as large as they fit into a picture with this width/height, less a
/// margin on each side. Unbounded solids, such as floors, and empty ones do not count; nothing where no other is there.
std::optional<Camera> framed_camera(const std::vector<Solid>& solids, const Framing& framing, Vec3 up, double aspect);

/// Places the scene's camera by its framing, if it has one, for a picture with this width/height, and the default
/// light by its camera. False where no solid is bounded: then the camera stays where it is.
bool frame_camera(Scene& scene, double aspect);

}  // namespace deburr
