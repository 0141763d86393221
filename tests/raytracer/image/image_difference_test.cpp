// Layers of pictures that are compared.
#include "raytracer/image/image_difference.hpp"

#include "catch.hpp"
#include "raytracer/folder.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// A picture with all layers whose channel `name` is renamed to `other`, a name of the same length.
Film with_renamed(const std::string& name, const std::string& other) {
    const Folder folder;
    std::string bytes = read_file(DEBURR_SOURCE_DIR "/tests/fuzz/image_corpus/layers.exr");
    const std::size_t at = bytes.find(name + std::string(1, '\0'));
    REQUIRE(at != std::string::npos);
    write_file(folder / "a.exr", bytes.replace(at, other.size(), other));
    return read_picture(folder / "a.exr");
}

}  // namespace

TEST_CASE("a layer of which a file has a part only is not read") {
    const Film whole = with_renamed("P.X", "P.X");
    CHECK(whole.keeps(ImageLayer::position));
    CHECK(whole.keeps(ImageLayer::normal));
    for (const std::string axis : {"X", "Y", "Z"}) {
        CAPTURE(axis);
        const Film part = with_renamed("P." + axis, "P.W");
        CHECK_FALSE(part.keeps(ImageLayer::position));
        CHECK(part.keeps(ImageLayer::normal));
        CHECK_FALSE(with_renamed("N." + axis, "N.W").keeps(ImageLayer::normal));
    }
}
