// A clear sky by day [Preetham, Shirley & Smits, A Practical Analytic Model for Daylight, 1999].
//
// The paper's luminances are in kcd/m²; here 30 of them are a radiance of 1, so that what is white in the sun at noon
// comes out near 1. Below the horizon the sky has the horizon's light. A sun below the horizon is taken to be on it.
#pragma once
#include <memory>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The sky without its sun and without Background::scale.
std::shared_ptr<const PictureData> daylight(const Background& background);
/// Irradiance by the sun of a surface that faces it; Background::scale is in it.
Vec3 sun_irradiance(const Background& background);

}  // namespace deburr
