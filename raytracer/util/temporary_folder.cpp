#include "raytracer/util/temporary_folder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "raytracer/util/errors.hpp"

namespace deburr {

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "deburr-XXXXXX").string();
    if (!mkdtemp(name.data()))
        throw WorkError(fmt::format("cannot make a folder '{}': {}", name, std::strerror(errno)));
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace deburr
