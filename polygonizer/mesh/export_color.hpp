// Colours of materials in files.
#pragma once
#include <array>
#include <cstdint>

#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// Linear; grey where the notes have none.
Vec3 material_color(const MeshNotes& notes, int material);

/// The material's colour as sRGB [IEC 61966-2-1], 8 bit.
std::array<std::uint8_t, 3> display_color(const MeshNotes& notes, int material);

}  // namespace deburr
