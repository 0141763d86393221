// --bits and --alpha: a PNG's pixels against those of the EXR of the same run.
#include <cmath>

#include "catch.hpp"
#include "raytracer/cli/scene_folder.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

namespace {

// A folder with a scene of the cube alone: there is background all around it.
struct FloorlessFolder : SceneFolder {
    FloorlessFolder() {
        std::string text = cube_scene();
        const std::size_t floor = text.find(", sharp(");
        text.replace(floor, text.find(" },", floor) - floor, "");
        write_file(scene, text);
    }
    void render(const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"render", scene,           "-q", "--spp",        "7", "--float",
                                          "-o",     *this / "a.exr", "-o", *this / "a.png"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome o = run(words);
        CAPTURE(o.err);
        REQUIRE(o.code == 0);
    }
};

double srgb(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

TEST_CASE("with --alpha colours are of solids alone, in an EXR weighed by alpha and in a PNG not") {
    const FloorlessFolder place;
    place.render({});
    const PictureFile whole = read_back(place / "a.exr");
    const double background[] = {0.6, 0.7, 0.8};
    for (const std::string bits : {"8", "16"}) {
        place.render({"--alpha", "--bits", bits});
        const PictureFile exr = read_back(place / "a.exr"), png = read_back(place / "a.png");
        REQUIRE(png.channels.size() == 4);
        CHECK(png.types == std::vector<std::string>(4, "uint" + bits));
        const double step = bits == "8" ? 1 / 255.0 : 1 / 65535.0;
        int empty = 0, full = 0, between = 0;
        for (std::size_t i = 0; i < whole.values.size(); i += 4) {
            const double alpha = exr.values[i + 3];
            (alpha == 0 ? empty : alpha == 1 ? full : between) += 1;
            REQUIRE(alpha == whole.values[i + 3]);
            REQUIRE(std::abs(png.values[i + 3] - alpha) <= 0.51 * step);
            for (std::size_t k = 0; k < 3; ++k) {
                const double color = exr.values[i + k];
                REQUIRE(std::abs(color + (1 - alpha) * background[k] - whole.values[i + k]) < 1e-5);
                const double straight = alpha > 0 ? color / alpha : 0;
                REQUIRE(std::abs(png.values[i + k] - srgb(straight)) <= 0.51 * step);
            }
        }
        CHECK(empty > 100);
        CHECK(full > 100);
        CHECK(between > 50);
    }
}

TEST_CASE("a PNG of 16 bits is opaque sRGB, and 8 bits are what they were") {
    const FloorlessFolder place;
    place.render({"--bits", "16"});
    const PictureFile exr = read_back(place / "a.exr"), words = read_back(place / "a.png");
    REQUIRE(words.types == std::vector<std::string>(3, "uint16"));
    for (std::size_t i = 0; i < exr.values.size() / 4; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            REQUIRE(std::abs(words.values[3 * i + k] - srgb(exr.values[4 * i + k])) < 0.51 / 65535);
    place.render({"--bits", "8"});
    CHECK(read_back(place / "a.png").types == std::vector<std::string>(3, "uint8"));
    const std::string asked = read_file(place / "a.png").substr(0, 33);
    place.render({});
    CHECK(read_file(place / "a.png").substr(0, 33) == asked);
}
