// The files of deburr mesh: which, with what in them, and that none is half there.
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <filesystem>

#include "bounds/vec.hpp"
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

TEST_CASE("--up z turns the scene's y into the files' z, and a GLB's not") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.1, box({-1, 2, 0}, {3, 7, 4})) } }");
    const auto box = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words{"mesh", folder / "s.lua", "-o", folder / name};
        words.insert(words.end(), more.begin(), more.end());
        REQUIRE(run(words).code == 0);
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(folder / name, aiProcess_PreTransformVertices);
        REQUIRE(scene != nullptr);
        deburr::Box box;
        int outward = 0, inward = 0;
        for (unsigned v = 0; v < scene->mMeshes[0]->mNumVertices; ++v) {
            const aiVector3D x = scene->mMeshes[0]->mVertices[v], n = scene->mMeshes[0]->mNormals[v];
            box = hull(box, {deburr::Vec3(x.x, x.y, x.z), deburr::Vec3(x.x, x.y, x.z)});
            const deburr::Vec3 middle =
                more.empty() || name == "b.glb" ? deburr::Vec3(1, 4.5, 2) : deburr::Vec3(1, -2, 4.5);
            const auto from_middle = deburr::Vec3(x.x, x.y, x.z) - middle;
            (glm::dot(from_middle, deburr::Vec3(n.x, n.y, n.z)) > 0 ? outward : inward) += 1;
        }
        CHECK(outward > 20);
        CHECK(inward == 0);
        return box;
    };
    using deburr::Vec3;
    for (const std::string name : {"a.stl", "a.obj", "a.ply"}) {
        CAPTURE(name);
        const deburr::Box as_it_is = box(name, {}), z = box(name, {"--up", "z"});
        CHECK(as_it_is.lo == Vec3(-1, 2, 0));
        CHECK(as_it_is.hi == Vec3(3, 7, 4));
        CHECK(z.lo == Vec3(-1, -4, 2));
        CHECK(z.hi == Vec3(3, 0, 7));
    }
    CHECK(box("b.glb", {"--up", "z"}).hi == Vec3(3, 7, 4));
    REQUIRE(run({"mesh", folder / "s.lua", "-o", folder / "a.obj", "--up", "z"}).code == 0);
    CHECK(read_file(folder / "a.obj").find("-0 ") == std::string::npos);
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
