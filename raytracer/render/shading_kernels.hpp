// How surfaces of a batch scatter light to the eye, of as many at a time as the processor's vectors hold. The
// instructions are chosen when the program starts (Highway).
//
// Each surface gets the same bits whatever else is in its batch, with any instructions: the same operations in the same
// order, none fused.
#pragma once
#include <span>
#include <vector>

#include "raytracer/render/bsdf.hpp"
#include "raytracer/render/lights.hpp"
#include "raytracer/render/surface_batch.hpp"
#include "raytracer/simd/instructions.hpp"

namespace deburr {

/// The kernels; `layers` are those that the surfaces' numbers mean. Each reads and sets fields of all surfaces.
struct ShadingFunctions {
    /// Turns `normal` to the eye, and sets `cos_eye`, `albedo_eye`, `base` and, to 0, `lit`.
    void (*see)(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `towards`, `distance` and `irradiance`: light that could come from `place` of the source, which is no
    /// sphere.
    void (*incident)(const LightSource& source, const SurfaceBatch& batch);

    /// Sets `scattered`: what comes to the eye of that light if nothing hides it (Bsdf); 0 where it comes from behind.
    void (*scatter)(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `towards` to the eye's mirror image, and `layer_albedo`.
    void (*mirror)(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `sky` and `mirrored` of a sky that is no picture: its mean around the normal, and what is mirrored of it,
    /// blurred by roughness.
    void (*sky)(const SkyLight& light, std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);

    /// Sets `shaded` to the light of the ambience, the lights, the sky and, of layers, `mirrored`.
    void (*shade)(Vec3 ambient, std::span<const SurfaceLayer> layers, const SurfaceBatch& batch);
};

/// The kernels of every set of instructions that this machine has, the widest first.
std::vector<Instructions<ShadingFunctions>> shading_instructions();

/// The kernels of the widest set of instructions that this machine has.
extern const ShadingFunctions& shading_functions;

}  // namespace deburr
