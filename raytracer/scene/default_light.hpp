// The light of a scene that defines none.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Gives a scene without a background a grey sky, adds a lamp, to be aimed by aim_default_light(), and constant ambient
/// light if the background is black; together they show a white matte surface below 1. A scene that is lit by a day sky
/// or an environment picture gets no lamp and no ambient light.
void add_default_light(Scene& scene, bool has_background);

/// Aims the default light over the viewer's left shoulder.
void aim_default_light(Scene& scene);

}  // namespace deburr
