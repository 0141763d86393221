// Camera, lights, background and materials in POV-Ray's words (pov_scene.hpp says how near).
#pragma once
#include <string>

#include "raytracer/image/film.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// assumed_gamma, depth of reflections, and the light from all around: the same everywhere, or, by POV-Ray's radiosity,
/// what other surfaces and the background send.
std::string pov_settings(const Scene& scene, bool radiosity);
std::string pov_camera(const Camera& camera, Size size);
std::string pov_background(const Background& background);
std::string pov_light(const Light& light, const Scene& scene);
std::string pov_material(const Material& material);

}  // namespace deburr
