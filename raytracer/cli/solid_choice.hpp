// The solids of a scene that a command is about, and their names in files.
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The indices of the solids that `only` (--only) names, each by its name or its number from 1; sorted, each once. A
/// name may belong to several solids. Throws UsageError, with the known names, for an unknown one.
std::vector<std::size_t> chosen_solids(const Scene& scene, const std::vector<std::string>& only);

/// A name for each solid in file names: its own name or else its number, with "_" for characters that are problematic
/// in file systems or shells. All are different, ignoring case.
std::vector<std::string> file_names(const Scene& scene);

}  // namespace deburr
