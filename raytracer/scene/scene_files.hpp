// Files that a scene may name: those in its own folder, and in others that the command line adds.
#pragma once
#include <string>
#include <vector>

namespace deburr {

class SceneFiles {
public:
    /// Files of the scene at this path; `others` are further folders, which are searched after its own.
    explicit SceneFiles(const std::string& scene, std::vector<std::string> others = {});

    /// The path of the file that the scene calls `name`. Throws std::runtime_error where there is none, where it is no
    /// file, and where it lies outside of these folders, be it by "..", by a path from the root or by links.
    std::string path_of(const std::string& name) const;

private:
    std::vector<std::string> folders_;
};

}  // namespace deburr
