// The files of deburr mesh: which, with what in them, and that none is half there.
#include <algorithm>
#include <filesystem>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;
namespace fs = std::filesystem;
using Names = std::vector<std::string>;

TEST_CASE("an OBJ comes with its MTL, and neither without the other") {
    const Folder folder;
    write_file(folder / "s.lua",
               "return { solids = { rounded(0.1, cube()):material(matte{color={0.25, 0.5, 1}}):name('red die') } }");
    REQUIRE(run({"mesh", folder / "s.lua", "-o", folder / "my part.obj"}).code == 0);
    CHECK(folder.names() == Names{"my part.mtl", "my part.obj", "s.lua"});
    const std::string obj = read_file(folder / "my part.obj");
    CHECK(obj.find("\nmtllib my part.mtl\n") != std::string::npos);
    CHECK(obj.find("\no red_die\nusemtl material_1\n") != std::string::npos);
    CHECK(read_file(folder / "my part.mtl") ==
          "# Deburr\nnewmtl material_1\nKa 0 0 0\nKd 0.25 0.5 1\nKs 0 0 0\nillum 1\n");

    fs::create_directory(folder / "a.mtl");
    const Outcome outcome = run({"mesh", folder / "s.lua", "-o", folder / "a.obj"});
    CHECK(outcome.code == 1);
    CHECK(outcome.err == "deburr: cannot write '" + folder / "a.mtl" + "': it is a folder\n");
    CHECK_FALSE(fs::exists(folder / "a.obj"));

    // A name with the end of a line in it is the MTL's with another character.
    REQUIRE(run({"mesh", folder / "s.lua", "-o", folder / "b\nc.obj"}).code == 0);
    CHECK(read_file(folder / "b\nc.obj").find("\nmtllib b_c.mtl\n") != std::string::npos);
    CHECK(fs::exists(folder / "b_c.mtl"));
}

TEST_CASE("an MTL is neither another output nor the scene") {
    const Folder folder;
    const std::string scene = "return { solids = { rounded(0.1, cube()) } }";
    write_file(folder / "s.mtl", scene);
    const Outcome over_scene = run({"mesh", folder / "s.mtl", "-o", folder / "s.obj"});
    CHECK(over_scene.code == 2);
    CHECK(over_scene.err.find("expected other files than the input") != std::string::npos);
    const Outcome twice = run({"mesh", folder / "s.mtl", "-o", folder / "a.obj", "-o", folder / "a.OBJ"});
    CHECK(twice.code == 2);
    CHECK(twice.err.find("expected different files") != std::string::npos);
    CHECK(run({"mesh", folder / "s.mtl", "-o", folder / "a.obj", "--stats-json", folder / "a.mtl"}).code == 2);
    CHECK(folder.names() == Names{"s.mtl"});
    CHECK(read_file(folder / "s.mtl") == scene);
}
