// A folder with a scene, and pictures read back, for tests that run the program.
#pragma once
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>
#include <vector>

#include "catch.hpp"
#include "raytracer/program.hpp"

namespace deburr::test {

using Words = std::vector<std::string>;

struct SceneFolder : Folder {
    std::string scene = *this / "cube.lua";
    SceneFolder() { write_file(scene, cube_scene()); }

    Words render(const Words& more, const std::string& output = "a.exr") const {
        Words words = {"render", scene, "-o", *this / output, "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

inline bool one_line(const std::string& text) {
    return !text.empty() && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

// A picture file's pixels in the file's own types.
struct Picture {
    OIIO::ImageSpec spec;
    std::vector<unsigned char> bytes;  // rows of interleaved channels
    std::size_t pixel = 0;

    explicit Picture(const std::string& path) {
        const auto input = OIIO::ImageInput::open(path);
        REQUIRE(input);
        spec = input->spec();
        pixel = spec.pixel_bytes(true);
        bytes.resize(spec.image_bytes(true));
        REQUIRE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UNKNOWN, bytes.data()));
    }
    const unsigned char* at(int x, int y) const {
        return bytes.data() + (std::size_t(y - spec.y) * std::size_t(spec.width) + std::size_t(x - spec.x)) * pixel;
    }
};

}  // namespace deburr::test
