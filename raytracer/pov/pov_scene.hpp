// A scene in the language of POV-Ray 3.7: the same shapes, camera and shadows; lights and materials as
// near as it has them.
//
// POV-Ray counts as left-handed only where a cross product is taken; the camera is written by its
// vectors, so coordinates are those of the scene. What differs: highlights are Blinn's, smooth layers
// reflect nothing but in metals, mirrors and glass, the sky lights every surface alike but with radiosity, area lights
// shine from both sides, and wood is POV-Ray's.
#pragma once
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"
#include "raytracer/pov/pov_solid.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

struct PovScene {
    std::string text;
    std::vector<std::string> warnings;
};

/// `surface.limit` is set here. With `radiosity` diffuse light goes from surface to surface, as it does in Deburr's
/// path tracer. Throws as pov_solid does.
PovScene pov_scene(const Scene& scene, Size size, PovSurface surface, bool radiosity = false);

}  // namespace deburr
