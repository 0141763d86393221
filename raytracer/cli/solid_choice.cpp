#include "raytracer/cli/solid_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "raytracer/util/errors.hpp"
#include "raytracer/util/nearest_name.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {
namespace {

std::string name_of(const Scene& scene, std::size_t solid) {
    return solid < scene.names.size() ? scene.names[solid] : "";
}

// A list such as "1 plate, 2, 3 knob".
std::string list_of_solids(const Scene& scene) {
    constexpr std::size_t most = 20;
    std::string list;
    for (std::size_t i = 0; i < std::min(most, scene.solids.size()); ++i) {
        const std::string name = name_of(scene, i);
        list += fmt::format("{}{}{}{}", i == 0 ? "" : ", ", i + 1, name.empty() ? "" : " ", name);
    }
    return list + (scene.solids.size() > most ? ", …" : "");
}

void choose(const Scene& scene, const std::string& which, std::set<std::size_t>& chosen) {
    bool found = false;
    for (std::size_t i = 0; i < scene.solids.size(); ++i)
        if (!which.empty() && name_of(scene, i) == which) {
            chosen.insert(i);
            found = true;
        }
    if (found) return;
    std::size_t number = 0;
    const char* end = which.data() + which.size();
    const auto [at, error] = std::from_chars(which.data(), end, number);
    if (error == std::errc() && at == end && number >= 1 && number <= scene.solids.size()) {
        chosen.insert(number - 1);
        return;
    }
    std::vector<std::string> names;
    for (const std::string& name : scene.names)
        if (!name.empty()) names.push_back(name);
    throw UsageError(fmt::format("--only: expected a solid's name or number ({}), got '{}'{}", list_of_solids(scene),
                                 which, suggestion(which, names)));
}

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
           static_cast<unsigned char>(c) >= 0x80;
}

std::string as_file_name(const std::string& name) {
    constexpr std::size_t longest = 100;  // bytes; a file name may have 255, including what surrounds it
    std::string plain = shortened(printable(name), longest);
    for (char& c : plain)
        if (!is_plain(c)) c = '_';
    if (plain[0] == '.' || plain[0] == '-') plain[0] = '_';  // otherwise a hidden file or an option
    return plain;
}

std::string in_small_letters(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return text;
}

}  // namespace

std::vector<std::size_t> chosen_solids(const Scene& scene, const std::vector<std::string>& only) {
    std::set<std::size_t> chosen;
    for (const std::string& which : only) choose(scene, which, chosen);
    return {chosen.begin(), chosen.end()};
}

std::vector<std::string> file_names(const Scene& scene) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    std::map<std::string, int> last;  // number appended to a name that several solids have
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        const std::string name = name_of(scene, i);
        const std::string wanted = name.empty() ? fmt::format("{}", i + 1) : as_file_name(name);
        std::string unique = wanted;
        for (int& n = last.try_emplace(in_small_letters(wanted), 1).first->second;
             !taken.insert(in_small_letters(unique)).second;)
            unique = fmt::format("{}-{}", wanted, ++n);
        names.push_back(unique);
    }
    return names;
}

}  // namespace deburr
