#include "raytracer/util/nearest_name.hpp"

#include <algorithm>
#include <cctype>

namespace deburr {

int typing_distance(std::string_view a, std::string_view b) {
    const auto same = [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
    };
    // The latest three rows of the table of distances between prefixes of a and b.
    std::vector<int> before, above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = int(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before = above;
        above = row;
        row[0] = int(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
            if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

std::string nearest_name(std::string_view given, const std::vector<std::string>& names) {
    constexpr std::size_t longest = 64;  // longer than any name; keeps the table small
    const std::size_t letters = given.size() - std::min(given.find_first_not_of('-'), given.size());
    if (letters == 0 || letters > longest) return "";
    std::string nearest;
    int least = int(letters) / 4 + 2;
    for (const std::string& name : names)
        if (const int distance = typing_distance(given, name); distance < least) {
            least = distance;
            nearest = name;
        }
    return nearest;
}

std::string suggestion(std::string_view given, const std::vector<std::string>& names) {
    const std::string name = nearest_name(given, names);
    return name.empty() ? "" : ", did you mean " + name + "?";
}

}  // namespace deburr
