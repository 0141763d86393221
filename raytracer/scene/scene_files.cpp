#include "raytracer/scene/scene_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "raytracer/util/printable.hpp"

namespace deburr {
namespace fs = std::filesystem;

SceneFiles::SceneFiles(const std::string& scene, std::vector<std::string> others) {
    const fs::path folder = fs::path(scene).parent_path();
    folders_.push_back(folder.empty() ? "." : folder.string());
    folders_.insert(folders_.end(), others.begin(), others.end());
}

std::string SceneFiles::path_of(const std::string& name) const {
    const std::string shown = shortened(printable(name), 200);
    if (name.empty() || name.find('\0') != std::string::npos)
        throw std::runtime_error(fmt::format("expected a file's name, got '{}'", shown));
    for (const std::string& folder : folders_) {
        std::error_code none;
        const fs::path path = fs::path(folder) / name;
        if (!fs::exists(path, none)) continue;
        // The targets of links decide.
        const fs::path real = fs::canonical(path, none), within = fs::canonical(folder, none);
        const auto [end, rest] = std::mismatch(within.begin(), within.end(), real.begin(), real.end());
        if (fs::path(name).is_absolute() || end != within.end())
            throw std::runtime_error(
                fmt::format("expected a file in the scene's folder '{}', got '{}' outside of it", folder, shown));
        if (fs::is_directory(real, none))
            throw std::runtime_error(fmt::format("expected a file, got the directory '{}'", shown));
        return path.string();
    }
    throw std::runtime_error(
        fmt::format("expected a file in the scene's folder '{}', found no '{}' there", folders_.front(), shown));
}

}  // namespace deburr
