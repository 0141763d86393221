// Messages of the program, apart from its results: lines on stderr. Errors in writing them are
// ignored.
#pragma once
#include <cstdio>
#include <string>

#include "raytracer/util/printable.hpp"

namespace deburr {

/// "deburr: TEXT" as one printable line, whatever a name in it holds.
inline void message(const std::string& text) {
    const std::string line = "deburr: " + printable(text) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace deburr
