// What a user is told of a picture that will show nothing, or not what was meant.
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Returns whether nothing in the scene shines: no lamp, no background, no material.
bool is_unlit(const Scene& scene);

/// A line each where no light reaches anything, where a lamp or the camera is inside a solid, where the camera sees
/// none of the bounded solids in a picture with this width/height, and where its angle of view is hardly meant.
std::vector<std::string> view_warnings(const Scene& scene, double aspect);

}  // namespace deburr
