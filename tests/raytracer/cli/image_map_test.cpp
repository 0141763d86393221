// image_map{}, from the file to the picture.
#include "catch.hpp"
#include "raytracer/cli/scene_folder.hpp"
#include "raytracer/picture_file.hpp"

using namespace deburr::test;

namespace {

// A scene with a wall of this material in front of the camera, under uniform light of radiance 1.
std::string wall(const std::string& material) {
    return "return { image = { width = 4, height = 4, spp = 4 }, lights = {}, ambient = 1, background = 0,"
           " camera = { eye = {0.5, 0.5, 5}, target = {0.5, 0.5, 0}, fov = 2 },"
           " solids = { sharp(halfspace({0, 0, 1}, 0)):material(" +
           material + ") } }";
}

}  // namespace

TEST_CASE("an image map shows the file's colours, and shares are the numbers in it") {
    SceneFolder folder;
    write_file(folder.scene, wall("matte{ color = 0.2158605 }"));
    REQUIRE(run(folder.render({}, "grey.png")).code == 0);  // 128 of 255 in sRGB
    write_file(folder.scene, wall("matte{ color = image_map{ file = 'grey.png' } }"));
    const Outcome shown = run(folder.render({"--float"}));
    CAPTURE(shown.err);
    REQUIRE(shown.code == 0);
    CHECK(read_back(folder / "a.exr").at(2, 2, "R") == Approx(0.2158605).epsilon(1e-4));

    // A metal reflects no ambient light; the rest of this material reflects all of it.
    write_file(folder.scene, wall("pbr{ color = 1, metallic = image_map{ file = 'grey.png' }, roughness = 1 }"));
    REQUIRE(run(folder.render({"--float"})).code == 0);
    const double half = read_back(folder / "a.exr").at(2, 2, "R");
    write_file(folder.scene, wall("pbr{ color = 1, metallic = 128 / 255, roughness = 1 }"));
    REQUIRE(run(folder.render({"--float"})).code == 0);
    CHECK(half == Approx(read_back(folder / "a.exr").at(2, 2, "R")).epsilon(1e-4));
}

TEST_CASE("a mesh has the mean of an image map's colours, and an STL does not ask for it") {
    SceneFolder folder;
    const std::string picture =
        "return { image = { width = 8, height = 8, spp = 1 }, lights = {}, ambient = 1,"
        " camera = { eye = {0, 0, 9}, fov = 5, projection = 'orthographic' }, background = 0,"
        " solids = { sharp(box({0, -9, -1}, {9, 9, 0})):material(matte{ color = 1 }) } }";
    write_file(folder.scene, picture);  // the left half is black, the right half white
    REQUIRE(run(folder.render({}, "half.png")).code == 0);
    write_file(folder.scene,
               "return { solids = { cube():material(matte{ color = image_map{ file = 'half.png' } }) } }");
    REQUIRE(run({"mesh", folder.scene, "-q", "-o", folder / "a.glb"}).code == 0);
    CHECK(read_file(folder / "a.glb").find("\"baseColorFactor\":[0.5,0.5,0.5,1") != std::string::npos);
    write_file(folder / "half.png", "no picture");
    CHECK(run({"mesh", folder.scene, "-q", "-o", folder / "a.stl"}).code == 0);
    const Outcome outcome = run({"mesh", folder.scene, "-q", "-o", folder / "a.glb"});
    CHECK(outcome.code == 2);
    CHECK(one_line(outcome.err));
}

TEST_CASE("an image map that cannot be read, or holds what its field does not take, is one line") {
    SceneFolder folder;
    write_file(folder / "words.png", "not a picture");
    write_file(folder.scene, wall("matte{}"));
    write_file(folder / "bright.lua",
               "return { lights = {}, background = 3, image = { width = 4, height = 4 },"
               " camera = { eye = {0, 0, 9} }, solids = { cube():translate(0, 0, 20) } }");
    REQUIRE(run({"render", folder / "bright.lua", "-q", "--spp", "1", "-o", folder / "bright.exr"}).code == 0);
    const auto said = [&](const std::string& material, const std::string& what, int code = 2) {
        write_file(folder.scene, wall(material));
        const Outcome outcome = run(folder.render({}));
        CAPTURE(outcome.err);
        CHECK(outcome.code == code);
        CHECK(one_line(outcome.err));
        CHECK(outcome.err.find(what) != std::string::npos);
    };
    said("matte{ color = image_map{ file = 'none.png' } }", "cube.lua:1: image_map.file: expected a file");
    said("matte{ color = image_map{ file = '../x.png' } }", "cube.lua:1: image_map.file: expected a file");
    said("matte{ color = image_map{} }", "cube.lua:1: image_map.file: expected a text, got nothing");
    said("matte{ color = image_map{ file = 'words.png' } }", "words.png': ");
    said("matte{ color = image_map{ file = 'bright.exr' } }", "bright.exr': expected numbers from 0 to 1, got 3");
    said("metal{ roughness = image_map{ file = 'bright.exr' } }", "bright.exr': expected numbers from 0 to 1, got 3");
    said("matte{ bump_height = 1 }", "cube.lua:1: matte.bump_height: expected a bump beside it, got none");
    said("matte{ bump = 1 }", "cube.lua:1: matte.bump: expected a texture, got 1");
    said("metal{ roughness = cube() }",
         "cube.lua:1: metal.roughness: expected a number from 0 to 1 or a texture, got a density");
    write_file(folder.scene, wall("matte{ bump = image_map{ file = 'bright.exr' } }"));
    CHECK(run(folder.render({})).code == 0);
}
