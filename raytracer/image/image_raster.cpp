#include "raytracer/image/image_raster.hpp"

#include <half.h>

namespace deburr {

std::uint16_t half_bits(double value) {
    constexpr double largest = 65504;
    return half(float(std::clamp(value, -largest, largest))).bits();
}

}  // namespace deburr
