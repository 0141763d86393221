// A scene in the language of POV-Ray 3.7: the same shapes, camera and shadows, and lights and materials as close as it
// has them.
//
// POV-Ray is left-handed only where a cross product is taken; the camera is written by its vectors, so coordinates are
// those of the scene. Differences: highlights are Blinn's; smooth layers reflect only in metals, mirrors and glass;
// without radiosity the sky lights every surface alike; area lights shine from both sides; wood is POV-Ray's.
// shine from both sides, and wood is POV-Ray's.
#pragma once
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"
#include "raytracer/pov/pov_solid.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The scene's text, and warnings about what was changed.
struct PovScene {
    std::string text;
    std::vector<std::string> warnings;
};

/// The scene as a picture of this size. `surface.limit` is set here. With `radiosity`, diffuse light passes from
/// surface to surface as in Deburr's path tracer. Throws as pov_solid() does.
PovScene pov_scene(const Scene& scene, Size size, PovSurface surface, bool radiosity = false);

}  // namespace deburr
