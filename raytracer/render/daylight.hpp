// A clear sky by day [Preetham, Shirley & Smits, A Practical Analytic Model for Daylight, 1999].
//
// The paper's luminances are in kcd/m²; here 30 of them are a radiance of 1, so that white in the sun at noon is near
// 1. Below the horizon the sky has the horizon's light, and a sun below the horizon is taken to be on it.
#pragma once
#include <memory>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The sky without its sun, as a picture by longitude and latitude; Background::scale is not applied.
std::shared_ptr<const PictureData> daylight(const Background& background);
/// The sun's irradiance on a surface that faces it, with Background::scale applied.
Vec3 sun_irradiance(const Background& background);

}  // namespace deburr
