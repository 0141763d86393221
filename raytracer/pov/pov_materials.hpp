// Settings, camera, lights, background and materials in POV-Ray's language; pov_scene.hpp lists the differences.
#pragma once
#include <string>

#include "raytracer/image/film.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The global settings: assumed_gamma, the depth of reflections, and indirect light, which is constant or, with
/// `radiosity`, what other surfaces and the background send.
std::string pov_settings(const Scene& scene, bool radiosity);
/// The statements for a camera, the background, a light of the scene, and a material.
std::string pov_camera(const Camera& camera, Size size);
std::string pov_background(const Background& background);
std::string pov_light(const Light& light, const Scene& scene);
std::string pov_material(const Material& material);

}  // namespace deburr
