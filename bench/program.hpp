// Programs as a user would run them, and what they cost.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace deburr::bench {

/// CPU seconds of the program with these words, and of all it starts; nothing if it is not installed.
/// What it says goes to `log` (or nowhere). Throws if it fails.
std::optional<double> cpu_seconds_of_program(const std::vector<std::string>& words,
                                             const std::string& log = "/dev/null");

/// A folder for the benchmark's files, which vanishes with them at the end.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

/// The deburr program of this build.
std::string deburr_program();

}  // namespace deburr::bench
