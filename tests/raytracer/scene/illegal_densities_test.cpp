// Reports of illegal densities in a scene.
#include "raytracer/scene/illegal_densities.hpp"

#include "catch.hpp"
#include "raytracer/scene/scene_reader.hpp"

using namespace deburr;

TEST_CASE("an illegal density is told with its place in the scene, once") {
    const std::string text =
        "local a = cube()\n"
        "local b = a + cube():translate(0.5, 0, 0)\n"
        "local c = cube() - box({0.2, 0.2, 0.2}, {0.8, 2, 0.8})\n"
        "return { solids = { rounded(0.1, b), rounded(0.1, b):translate(3, 0, 0), rounded(0.1, c) } }\n";
    const std::vector<std::string> reported = illegal_densities(read_scene_text(text, "plate.lua", {}));
    REQUIRE(reported.size() == 2);
    CHECK(reported[0].rfind("plate.lua:2: sum: expected a density of at most 1, got ", 0) == 0);
    CHECK(reported[0].find("its parts overlap: use |") != std::string::npos);
    CHECK(reported[1].rfind("plate.lua:3: difference: expected a density of at least 0, got -", 0) == 0);
    CHECK(reported[1].find("sticks out") != std::string::npos);
}
