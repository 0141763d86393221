// A batch of opaque surfaces in a preview, as a structure of arrays, so that one vector instruction shades as many as a
// register holds (shading_kernels.hpp).
#pragma once
#include <array>
#include <cstdint>

#include "bounds/vec.hpp"

namespace deburr {

/// The values of a surface, each named by the index of its first array; vectors and colours have three arrays.
/// Directions are unit and lead away from the surface.
enum class SurfaceField {
    position = 0,
    normal = 3,  // shading normal; after see() on the side of `to_eye`
    to_eye = 6,
    color = 9,        // of the material at the point
    base = 12,        // of the base below the layer, after see()
    lit = 15,         // light scattered to the eye so far
    towards = 18,     // direction to the light, later the eye's mirror direction
    irradiance = 21,  // of the light, without occlusion
    scattered = 24,   // the share of `irradiance` that is scattered to the eye
    sky = 27,         // mean radiance of the sky around the normal
    mirrored = 30,    // the layer's reflection of the sky
    shaded = 33,      // radiance towards the eye
    cos_eye = 36,     // cosine of `to_eye`, after see()
    albedo_eye = 37,  // of the layer, seen from the eye
    distance = 38,    // to the light
    place = 39,       // on an extended light: two numbers from 0 to 1
    layer_albedo = 41,
    lit_by = 44,  // light of one source's samples scattered so far
    end = 47
};

/// A view of the arrays of `count` surfaces; it does not own them.
struct SurfaceBatch {
    std::size_t count = 0;
    std::size_t stride = 0;  // between arrays; a multiple of the widest vector's size
    double* numbers = nullptr;
    std::int32_t* layer = nullptr;  // of each surface: index of its layer (material)

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

/// Memory for a batch of at most `capacity` surfaces.
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
