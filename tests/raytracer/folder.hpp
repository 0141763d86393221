// A temporary folder for a test, and reading and writing whole files.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace deburr::test {

using Names = std::vector<std::string>;

/// A new temporary folder, which is removed with everything in it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    /// Path of the file `name` in the folder.
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    /// Names of everything in the folder, hidden files too, sorted.
    Names names() const;

private:
    std::filesystem::path path_;
};

/// The bytes of a file; "" if it cannot be read.
std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);

}  // namespace deburr::test
