// What the program tells people, apart from results: lines on stderr. That nobody can read them is
// no error.
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
