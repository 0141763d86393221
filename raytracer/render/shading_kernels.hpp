// Vector kernels that shade a batch of surfaces in previews, as many at a time as a register holds. The instruction set
// is chosen when the program starts (Highway).
//
// Each surface gets the same bits whatever else is in its batch, with any instruction set: the same operations in the
// same order, none of them fused.
#pragma once
#include <span>
#include <vector>

#include "raytracer/render/bsdf.hpp"
#include "raytracer/render/lights.hpp"
#include "raytracer/render/surface_batch.hpp"
#include "raytracer/simd/instructions.hpp"

namespace deburr {

/// The kernels. Each reads and sets fields of all surfaces of a batch; `layers` are indexed by SurfaceBatch::layer.
struct ShadingFunctions {
    /// Turns `normal` to the eye's side, and sets `cos_eye`, `albedo_eye`, `base`, and `lit` to 0.
    void (*see)(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `towards`, `distance` and `irradiance` for light from `place` of the source, which must not be a sphere.
    void (*incident)(const LightSource& source, const SurfaceBatch& batch);

    /// Sets `scattered`: the light of that direction scattered to the eye, without occlusion; 0 for light from behind.
    void (*scatter)(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `towards` to the eye's mirror direction, and `layer_albedo`.
    void (*mirror)(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `sky` and `mirrored` for a sky that is not sampled: its mean around the normal, and its reflection, blurred
    /// by roughness.
    void (*sky)(const SkyLight& light, std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `shaded` to the sum of the light from ambient, lights, sky and (for layers) `mirrored`.
    void (*shade)(Vec3 ambient, std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);
};

/// The kernels for every instruction set that this machine has, the widest first.
std::vector<Instructions<ShadingFunctions>> shading_instructions();

/// The kernels for the widest instruction set that this machine has.
extern const ShadingFunctions& shading_functions;

}  // namespace deburr
