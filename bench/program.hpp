// Runs programs and measures their CPU time; temporary folders.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace deburr::bench {

/// CPU seconds of the program with these arguments and of all its children; none if it is not installed. Its output
/// goes to `log`. Throws if it fails.
std::optional<double> cpu_seconds_of_program(const std::vector<std::string>& words,
                                             const std::string& log = "/dev/null");

/// A temporary folder that is removed with its files at the end.
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

/// The path of the deburr program of this build.
std::string deburr_program();

}  // namespace deburr::bench
