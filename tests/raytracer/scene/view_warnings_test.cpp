// Warnings about scenes whose picture shows nothing or not what was meant.
#include "raytracer/scene/view_warnings.hpp"

#include "catch.hpp"
#include "raytracer/scene/frame_camera.hpp"
#include "raytracer/scene/scene_reader.hpp"

using namespace deburr;

namespace {

std::vector<std::string> warnings_of(const std::string& fields, const std::string& solids = "cube()") {
    Scene scene = read_scene_text("return { " + fields + " solids = { " + solids + " } }", "s.lua");
    frame_camera(scene, 1.5);
    return view_warnings(scene, 1.5);
}

std::vector<std::string> one(const std::string& line) { return {"s.lua: " + line}; }

}  // namespace

TEST_CASE("a scene that shows what was meant gets no warning") {
    CHECK(warnings_of("").empty());
    CHECK(warnings_of("", "cube(), halfspace({0, 1, 0}, 0)").empty());
    CHECK(warnings_of("lights = {}, background = 0.5,").empty());
    CHECK(warnings_of("lights = { directional_light{ direction = {0, -1, 0} } },").empty());
}

TEST_CASE("no light, an odd angle, and a camera that sees nothing are one line each") {
    const std::string dark = "there is no light: give lights, a background or ambient, or leave all of them out";
    CHECK(warnings_of("lights = {},") == one(dark));
    CHECK(warnings_of("lights = { point_light{ position = {9, 9, 9}, power = 0 } },") == one(dark));
    CHECK(warnings_of("camera = frame{ fov = 0.7 },") ==
          one("camera: the fov is 0.7 degrees; if these are radians, write 40.1"));
    CHECK(warnings_of("camera = frame{ fov = 150 },") ==
          one("camera: a fov of 150 degrees distorts; 20 to 60 are usual"));
    const std::string nothing = "the camera sees none of the bounded solids; --frame moves it to where it does";
    CHECK(warnings_of("camera = { eye = {0, 0, 9}, target = {0, 0, 20} },") == one(nothing));
    CHECK(warnings_of("camera = { eye = {0, 0, 9}, target = {9, 0, 9} },", "cube(), halfspace({0, 1, 0}, -1)") ==
          one(nothing));
    CHECK(warnings_of("camera = { eye = {0, 0, 9}, target = {0.5, 0.5, 0} },").empty());
    CHECK(warnings_of("", "halfspace({0, 1, 0}, 0)") ==
          one("no solid is bounded, so there is nothing to frame: give a camera"));
}

TEST_CASE("a camera and lamps inside a solid are told, but not those in glass") {
    const std::string inside = "camera = { eye = {0.5, 0.5, 0.5}, target = {9, 9, 9} },";
    CHECK(warnings_of(inside)[0] == "s.lua: the camera is inside solid 1, at (0.5, 0.5, 0.5)");
    CHECK(warnings_of(inside, "cube():name('die')")[0] ==
          "s.lua: the camera is inside solid 1 (die), at (0.5, 0.5, 0.5)");
    CHECK(warnings_of("camera = { eye = {0.5, 0.5, 0.5}, target = {1, 1, 1} },", "cube():material(glass{})").empty());
    CHECK(warnings_of(
              "lights = { directional_light{ direction = {0, -1, 0} }, point_light{ position = {0.5, 0.5, 0.5} } },") ==
          one("light 2 is inside solid 1, at (0.5, 0.5, 0.5)"));
}
