// A folder for a test to work in, and whole files.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace deburr::test {

/// A fresh folder that vanishes with everything in it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    /// Path of a file in it.
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    /// Names of all that is in it, hidden files too, in order.
    std::vector<std::string> names() const;

private:
    std::filesystem::path path_;
};

std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);

}  // namespace deburr::test
