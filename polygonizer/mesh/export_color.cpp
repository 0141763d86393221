#include "polygonizer/mesh/export_color.hpp"

#include <algorithm>

namespace deburr {

Vec3 material_color(const MeshNotes& notes, int material) {
    constexpr double grey = 0.8;
    return std::size_t(material) < notes.colors.size() ? notes.colors[material] : Vec3(grey);
}

std::array<std::uint8_t, 3> display_color(const MeshNotes& notes, int material) {
    const Vec3 linear = material_color(notes, material);
    std::array<std::uint8_t, 3> bytes;
    for (int k = 0; k < 3; ++k) {
        const double x = std::clamp(linear[k], 0.0, 1.0);
        const double v = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        bytes[k] = std::uint8_t(std::lround(255 * v));
    }
    return bytes;
}

}  // namespace deburr
