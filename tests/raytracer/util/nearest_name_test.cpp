// The typing distance, and suggestions for mistyped names.
#include "raytracer/util/nearest_name.hpp"

#include "catch.hpp"

using namespace deburr;

TEST_CASE("the typing distance counts letters inserted, left out, replaced, and swapped with their neighbour") {
    CHECK(typing_distance("", "") == 0);
    CHECK(typing_distance("abc", "") == 3);
    CHECK(typing_distance("render", "render") == 0);
    CHECK(typing_distance("Render", "rENDER") == 0);
    CHECK(typing_distance("rendr", "render") == 1);
    CHECK(typing_distance("rendder", "render") == 1);
    CHECK(typing_distance("rander", "render") == 1);
    CHECK(typing_distance("redner", "render") == 1);
    CHECK(typing_distance("kitten", "sitting") == 3);
    CHECK(typing_distance("ca", "abc") == 3);  // optimal string alignment; the full Damerau-Levenshtein distance is 2
}

TEST_CASE("the nearest name is suggested, and none where nothing is near") {
    const std::vector<std::string> names = {"matte", "metal", "plastic", "point_light", "|"};
    CHECK(nearest_name("mattte", names) == "matte");
    CHECK(nearest_name("plastik", names) == "plastic");
    CHECK(nearest_name("pointlight", names) == "point_light");
    CHECK(nearest_name("sphere", names) == "");
    CHECK(nearest_name("", names) == "");
    CHECK(nearest_name("--", {"-q"}) == "");
    CHECK(nearest_name("--foo", {"--aov", "--fool"}) == "--fool");
    CHECK(nearest_name("--foo", {"--aov"}) == "");
    CHECK(nearest_name(std::string(1'000'000, 'm'), names) == "");
    CHECK(suggestion("mettal", names) == ", did you mean metal?");
    CHECK(suggestion("xyzzy", names) == "");
    CHECK(suggestion("matte", {}) == "");
}
