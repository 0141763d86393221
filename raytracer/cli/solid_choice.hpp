// Which solids of a scene a command is about, and what files of theirs are called.
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The places in the scene of the solids that `only` (--only) names, each by its name or its number from 1; in order,
/// each once. A name may be that of several solids. Throws UsageError, with the names that there are, for what is
/// neither.
std::vector<std::size_t> chosen_solids(const Scene& scene, const std::vector<std::string>& only);

/// What stands for each solid of the scene in the name of a file: its name or else its number, with "_" for what file
/// systems or shells may stumble over. All are different, without regard to small and capital letters.
std::vector<std::string> file_names(const Scene& scene);

}  // namespace deburr
