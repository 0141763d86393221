#include "raytracer/picture_file.hpp"

#include <algorithm>

#include "catch.hpp"
#include "raytracer/util/module.hpp"

namespace deburr::test {

std::size_t PictureFile::channel(const std::string& name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    if (found == channels.end()) FAIL("expected a channel " << name);
    return std::size_t(found - channels.begin());
}

PictureFile read_back(const std::string& path) {
    static PictureReader* const read =
        module_function<PictureReader>(DEBURR_PICTURE_READER, picture_reader, "tests of pictures");
    PictureFile picture;
    read(path.c_str(), picture);
    return picture;
}

}  // namespace deburr::test
