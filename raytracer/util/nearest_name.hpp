// Suggests the name that a mistyped one may have meant.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace deburr {

/// The number of letters to insert, delete, replace or swap with a neighbour to turn `a` into `b` (optimal string
/// alignment). Case is ignored.
int typing_distance(std::string_view a, std::string_view b);

/// The name nearest to `given`, the first of equals; "" if all are too far away: more than one letter plus a quarter of
/// the letters of `given`. Leading dashes of an option do not count as letters.
std::string nearest_name(std::string_view given, const std::vector<std::string>& names);

/// ", did you mean NAME?", or "" if no name is near.
std::string suggestion(std::string_view given, const std::vector<std::string>& names);

}  // namespace deburr
