// The name that a mistyped one may have meant.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace deburr {

/// The number of letters to insert, leave out, replace, or swap with their neighbour, to make `b` of `a`
/// (optimal string alignment). Small and capital letters are the same.
int typing_distance(std::string_view a, std::string_view b);

/// The name that is nearest to `given`, the first of them where several are; "" if all are too far to be meant: more
/// than one letter and a fourth of the letters away. Dashes in front of an option are no letters.
std::string nearest_name(std::string_view given, const std::vector<std::string>& names);

/// ", did you mean NAME?", or "" where nothing is near.
std::string suggestion(std::string_view given, const std::vector<std::string>& names);

}  // namespace deburr
