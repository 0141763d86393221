// tostring() of the values of a scene.
#include "catch.hpp"
#include "raytracer/scene/scene_reader.hpp"

using namespace deburr;

namespace {

// What tostring() returns for this value in a scene.
std::string text_of(const std::string& value) {
    const std::string scene = "return { solids = { cube():name(tostring(" + value + ")) } }";
    return read_scene_text(scene, "s.lua").names.at(0);
}

}  // namespace

TEST_CASE("tostring says what a value is, without an address") {
    CHECK(text_of("cube()") == "density of 6 half-spaces, [0, 1]³");
    CHECK(text_of("cube():radius(0.1)") == "density of 6 half-spaces, [0, 1]³, radius 0.1");
    CHECK(text_of("cube():radius(0.1) * halfspace({0, 1, 0}, 0.5):radius(0.2)") ==
          "density of 7 half-spaces, [0, 1] x [0, 0.5] x [0, 1], radii from 0.1 to 0.2");
    CHECK(text_of("halfspace({0, 1, 0}, 2)") == "density of 1 half-space, [-inf, inf] x [-inf, 2] x [-inf, inf]");
    CHECK(text_of("rounded(0.1, cube())") == "solid of 6 half-spaces, [0, 1]³, radius 0.1");
    CHECK(text_of("rounded(0.1, cube()):name('lid')") == "'lid': solid of 6 half-spaces, [0, 1]³, radius 0.1");
    CHECK(text_of("sharp(cube()) - ellipsoid{}").rfind("solid of 6 half-spaces and smooth surfaces, ", 0) == 0);
    CHECK(text_of("ellipsoid{ radius = 2 }") == "quadric, [-2, 2]³");
    CHECK(text_of("perturbation(3, ellipsoid{})") == "perturbation by 3 in [-1, 1]³");
    CHECK(text_of("plastic{ color = {0.7, 0.1, 0.1} }") ==
          "plastic{ color = {0.7, 0.1, 0.1}, roughness = 0.2, ior = 1.5 }");
    CHECK(text_of("matte{ color = checker{ scale = 2 } }") ==
          "matte{ color = checker{ a = 0.8, b = 0.2, scale = 2 } }");
    CHECK(text_of("point_light{ position = {1, 2, 3} }") ==
          "point_light{ position = {1, 2, 3}, color = 1, power = 1 }");
    CHECK(text_of("sky{ horizon = 1 }") == "sky{ horizon = 1, zenith = {0.2, 0.28, 0.4} }");
    CHECK(text_of("frame{ fov = 20 }") == "frame{ from = {3, 2, 4}, fov = 20 }");
}

TEST_CASE("lists of a few numbers are shown, other tables are not") {
    CHECK(text_of("{1, 2.5, -3}") == "{1, 2.5, -3}");
    CHECK(text_of("{7}") == "{7}");
    CHECK(text_of("{}") == "table");
    CHECK(text_of("{1, 'a'}") == "table");
    CHECK(text_of("{1, 2, x = 3}") == "table");
    CHECK(text_of("setmetatable({1, 2}, {})") == "table");
    CHECK(text_of("print") == "function");
}

TEST_CASE("large things are described without being laid out") {
    CHECK(
        text_of("(function() local a = cube() for i = 1, 10 do a = a | a:translate(2 * i, 0, 0) end return a end)()") ==
        "density of 6144 half-spaces");
}
