// Advice on exposure, and the option --exposure.
#include "raytracer/image/exposure.hpp"

#include "catch.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// A picture of 1000 pixels; the first `count` have the value `bright`, the others `rest`.
Film film_of(int count, double bright, double rest) {
    Film film(100, 10, {0, 0, 100, 10}, {});
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        film.pixels[i] = Pixel{.color = Vec3(0, int(i) < count ? bright : rest, 0), .alpha = 1};
    return film;
}

}  // namespace

TEST_CASE("a picture that is clipped in a large part, or nearly black, is told the exposure that shows it") {
    CHECK_FALSE(exposure_advice(film_of(50, 100, 0.5), 0));
    CHECK(exposure_advice(film_of(51, 4, 0.5), 0) ==
          "5 % of the pixels are brighter than white and clipped; --exposure -2.0 shows them");
    CHECK_FALSE(exposure_advice(film_of(51, 4, 0.5), -2));
    CHECK(exposure_advice(film_of(500, 0.9, 0.1), 1) ==
          "50 % of the pixels are brighter than white and clipped; --exposure 0.1 shows them");
    CHECK(exposure_advice(film_of(500, 0.015625, 0), 0) == "the picture is nearly black; --exposure 6.0 shows it");
    CHECK_FALSE(exposure_advice(film_of(500, 0.015625, 0), 6));
    CHECK(exposure_advice(film_of(0, 0, 0), 0) == "the picture is black: no light falls on what the camera sees");
    CHECK_FALSE(exposure_advice(film_of(1, 0.5, 0), 0));
    CHECK_FALSE(exposure_advice(Film(100, 10, {0, 0, 100, 10}, {}), 0));  // a picture without any surface
}

TEST_CASE("an exposure of -1 halves the light of a PNG, and leaves an EXR as it is") {
    const Folder folder;
    const std::string scene = folder / "s.lua";
    write_file(scene,
               "return { image = { width = 8, height = 8, spp = 1 }, background = 0.5, lights = {}, "
               "camera = { eye = {0, 9, 0}, target = {0, 99, 0}, up = {1, 0, 0} }, solids = { cube() } }");
    const std::string png = folder / "a.png", deep = folder / "b.png", exr = folder / "a.exr";
    REQUIRE(run({"render", scene, "-q", "--exposure", "-1", "-o", png, "-o", exr}).code == 0);
    REQUIRE(run({"render", scene, "-q", "--exposure=+0.5", "--bits", "16", "-o", deep}).code == 0);
    CHECK(int(std::lround(255 * read_back(png).at(4, 4, "R"))) == srgb_byte(0.25));
    CHECK(int(std::lround(65535 * read_back(deep).at(4, 4, "R"))) == srgb_word(0.5 * std::sqrt(2.0)));
    const PictureFile linear = read_back(exr);
    CHECK(linear.at(4, 4, "R") == 0.5);
    CHECK(linear.attribute<std::string>("deburr.exposure") == "-1");
}

TEST_CASE("the scene's exposure is that of its pictures, unless the command line says another") {
    const Folder folder;
    const std::string scene = folder / "s.lua", png = folder / "a.png";
    write_file(scene,
               "return { image = { width = 8, height = 8, spp = 1, exposure = 1 }, background = 0.25, lights = "
               "{}, camera = { eye = {0, 9, 0}, target = {0, 99, 0}, up = {1, 0, 0} }, solids = { cube() } }");
    REQUIRE(run({"render", scene, "-q", "-o", png}).code == 0);
    CHECK(int(std::lround(255 * read_back(png).at(4, 4, "R"))) == srgb_byte(0.5));
    const std::string other = folder / "b.png";
    REQUIRE(run({"render", scene, "-q", "--exposure", "0", "-o", other}).code == 0);
    CHECK(int(std::lround(255 * read_back(other).at(4, 4, "R"))) == srgb_byte(0.25));
    CHECK(run({"render", scene, "--exposure", "31", "-o", png}).err ==
          "deburr: --exposure: expected a number from -30 to 30, got '31'\n");
}
