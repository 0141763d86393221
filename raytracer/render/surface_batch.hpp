// Opaque surfaces that rays of a preview have met, many at a time, in arrays of their coordinates (structure of
// arrays), so that one vector instruction shades as many of them as the processor's vectors hold (shading_kernels.hpp).
#pragma once
#include <array>
#include <cstdint>

#include "bounds/vec.hpp"

namespace deburr {

/// What is kept of a surface: the first of the arrays of its coordinates or, where it is a number, the only one.
/// Directions are unit and lead away from the surface.
enum class SurfaceField {
    position = 0,
    normal = 3,  // shading normal; once seen, on the side of `to_eye`
    to_eye = 6,
    color = 9,        // of the material here
    base = 12,        // colour of the base below the layer, once seen
    lit = 15,         // what it scatters to the eye of the lights so far
    towards = 18,     // the light, then the mirrored eye
    irradiance = 21,  // of the light, if nothing hides it
    scattered = 24,   // what it scatters to the eye of that
    sky = 27,         // mean radiance of the sky around the normal
    mirrored = 30,    // what the layer reflects of the sky
    shaded = 33,      // radiance to the eye
    cos_eye = 36,     // cosine of `to_eye`, once seen
    albedo_eye = 37,  // the layer's, from there
    distance = 38,    // to the light
    place = 39,       // on an extended light: two numbers from 0 to 1
    layer_albedo = 41,
    lit_by = 44,  // what it scatters of one light's samples so far
    end = 47
};

/// Numbers and layers of `count` surfaces. It does not own them.
struct SurfaceBatch {
    std::size_t count = 0;
    std::size_t stride = 0;  // from an array to the next; a multiple of the widest vector's numbers
    double* numbers = nullptr;
    std::int32_t* layer = nullptr;  // of each surface, its material's

    double* array(SurfaceField field, int axis = 0) const { return numbers + (int(field) + axis) * stride; }
    double get(SurfaceField field, std::size_t i) const { return array(field)[i]; }
    Vec3 vec(SurfaceField field, std::size_t i) const {
        return {array(field, 0)[i], array(field, 1)[i], array(field, 2)[i]};
    }
    void set(SurfaceField field, std::size_t i, double value) const { array(field)[i] = value; }
    void set(SurfaceField field, std::size_t i, Vec3 value) const {
        for (int axis = 0; axis < 3; ++axis) array(field, axis)[i] = value[axis];
    }
};

/// Room for a batch of up to `capacity` surfaces.
template <std::size_t capacity>
class SurfaceArrays {
public:
    SurfaceBatch batch(std::size_t count) { return {count, capacity, numbers_.data(), layer_.data()}; }

private:
    static_assert(capacity % 8 == 0);
    alignas(64) std::array<double, std::size_t(SurfaceField::end) * capacity> numbers_{};
    std::array<std::int32_t, capacity> layer_{};
};

}  // namespace deburr
