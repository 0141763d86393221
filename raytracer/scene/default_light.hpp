// The light of a scene that says nothing about light.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Adds a lamp, to be aimed by aim_default_light, and what fills its shadows: the background, or a grey one where the
/// scene has none. Together they show a white matte surface below 1. A day and a picture around the scene need neither.
void add_default_light(Scene& scene, bool has_background);

/// Turns the default light over the viewer's left shoulder.
void aim_default_light(Scene& scene);

}  // namespace deburr
