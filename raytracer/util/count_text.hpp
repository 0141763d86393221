// Counts with their noun, for messages.
#pragma once
#include <string>
#include <string_view>

namespace deburr {

/// "1 facet", "2 facets": `what` is the noun in the singular, whose plural ends in s.
inline std::string count_of(std::size_t n, std::string_view what) {
    return std::to_string(n) + " " + std::string(what) + (n == 1 ? "" : "s");
}

}  // namespace deburr
