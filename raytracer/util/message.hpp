// Messages of the program that are not its results: lines on stderr. Write errors are ignored.
#pragma once
#include <cstdio>
#include <string>

#include "raytracer/util/printable.hpp"

namespace deburr {

/// Prints "deburr: TEXT" as one printable line, whatever characters the text contains.
inline void message(const std::string& text) {
    const std::string line = "deburr: " + printable(text) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace deburr
