// A folder for files that nobody keeps.
#pragma once
#include <filesystem>

namespace deburr {

/// A new folder among the system's temporary ones; it goes with what is in it when this does.
class TemporaryFolder {
public:
    /// Throws WorkError where none can be made.
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

}  // namespace deburr
