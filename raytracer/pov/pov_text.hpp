// Vectors, colours and indentation in POV-Ray's scene language.
#pragma once
#include <fmt/format.h>

#include <string>

#include "bounds/vec.hpp"

namespace deburr {

inline std::string pov_vector(Vec3 v) {
    v += 0.0;  // turns −0 into 0
    return fmt::format("<{}, {}, {}>", v.x, v.y, v.z);
}
inline std::string pov_color(Vec3 c) { return fmt::format("rgb <{}, {}, {}>", c.x, c.y, c.z); }

/// The text with every line indented by two spaces.
inline std::string pov_indented(const std::string& text) {
    std::string out = "  ";
    for (const char c : text) {
        out += c;
        if (c == '\n') out += "  ";
    }
    return out;
}

}  // namespace deburr
