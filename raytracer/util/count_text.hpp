// How many of something, in words.
#pragma once
#include <string>
#include <string_view>

namespace deburr {

/// "1 facet", "2 facets".
inline std::string count_of(std::size_t n, std::string_view what) {
    return std::to_string(n) + " " + std::string(what) + (n == 1 ? "" : "s");
}

}  // namespace deburr
