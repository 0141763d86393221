// Colours of materials in mesh files.
#pragma once
#include <array>
#include <cstdint>

#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// The material's linear colour; grey where the notes have none.
Vec3 material_color(const MeshNotes& notes, int material);

/// The material's colour as 8-bit sRGB [IEC 61966-2-1].
std::array<std::uint8_t, 3> display_color(const MeshNotes& notes, int material);

}  // namespace deburr
