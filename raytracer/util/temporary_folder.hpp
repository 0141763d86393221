// A temporary folder that is removed at the end of its scope.
#pragma once
#include <filesystem>

namespace deburr {

/// A new folder in the system's temporary directory; the destructor removes it with its contents.
class TemporaryFolder {
public:
    /// Throws WorkError if no folder can be made.
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

}  // namespace deburr
