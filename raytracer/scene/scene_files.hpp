// Files that a scene may read: those in its own folder, and in folders that the command line adds.
#pragma once
#include <string>
#include <vector>

namespace deburr {

/// The folders of one scene.
class SceneFiles {
public:
    /// The folders of the scene at this path; `others` are searched after its own.
    explicit SceneFiles(const std::string& scene, std::vector<std::string> others = {});

    /// The path of the file that the scene calls `name`. Throws std::runtime_error if there is none, if it is not a
    /// regular file, or if it is outside of these folders, be it by "..", by an absolute path or by links.
    std::string path_of(const std::string& name) const;

private:
    std::vector<std::string> folders_;
};

}  // namespace deburr
