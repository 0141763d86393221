// The files that `deburr mesh` writes: their names, their contents, and that none is incomplete.
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

    // A line break in the name is replaced by another character in the MTL's name.
    REQUIRE(run({"mesh", folder / "s.lua", "-o", folder / "b\nc.obj"}).code == 0);
    CHECK(read_file(folder / "b\nc.obj").find("\nmtllib b_c.mtl\n") != std::string::npos);
    CHECK(fs::exists(folder / "b_c.mtl"));
}

TEST_CASE("mesh --up z turns the scene's y into the files' z, and a GLB's not") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.1, box({-1, 2, 0}, {3, 7, 4})) } }");
    const auto box = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words{"mesh", folder / "s.lua", "-o", folder / name};
        words.insert(words.end(), more.begin(), more.end());
        REQUIRE(run(words).code == 0);
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(folder / name, aiProcess_PreTransformVertices);
        REQUIRE(scene != nullptr);
        deburr::Box all;
        int outward = 0, inward = 0;
        for (unsigned v = 0; v < scene->mMeshes[0]->mNumVertices; ++v) {
            const aiVector3D x = scene->mMeshes[0]->mVertices[v], n = scene->mMeshes[0]->mNormals[v];
            all = hull(all, {deburr::Vec3(x.x, x.y, x.z), deburr::Vec3(x.x, x.y, x.z)});
            const deburr::Vec3 middle =
                more.empty() || name == "b.glb" ? deburr::Vec3(1, 4.5, 2) : deburr::Vec3(1, -2, 4.5);
            const auto from_middle = deburr::Vec3(x.x, x.y, x.z) - middle;
            (glm::dot(from_middle, deburr::Vec3(n.x, n.y, n.z)) > 0 ? outward : inward) += 1;
        }
        CHECK(outward > 20);
        CHECK(inward == 0);
        return all;
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
}

TEST_CASE("a scene with z up goes out as it is, and a GLB of it y-up") {
    const Folder folder;
    write_file(folder / "s.lua", "return { up = 'z', solids = { box({-1, 2, 0}, {3, 7, 4}) } }");
    const auto box = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words{"mesh", folder / "s.lua", "-o", folder / name};
        words.insert(words.end(), more.begin(), more.end());
        REQUIRE(run(words).code == 0);
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(folder / name, aiProcess_PreTransformVertices);
        REQUIRE(scene != nullptr);
        deburr::Box all;
        for (unsigned v = 0; v < scene->mMeshes[0]->mNumVertices; ++v) {
            const aiVector3D x = scene->mMeshes[0]->mVertices[v];
            all = hull(all, {deburr::Vec3(x.x, x.y, x.z), deburr::Vec3(x.x, x.y, x.z)});
        }
        return all;
    };
    using deburr::Vec3;
    CHECK(box("a.stl", {}).hi == Vec3(3, 7, 4));
    CHECK(box("a.stl", {"--up", "z"}).hi == Vec3(3, 7, 4));
    const deburr::Box y = box("a.stl", {"--up", "y"}), glb = box("b.glb", {});
    CHECK(y.lo == Vec3(-1, 0, -7));
    CHECK(y.hi == Vec3(3, 4, -2));
    CHECK(glb.lo == y.lo);
    CHECK(glb.hi == y.hi);
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

namespace {

// Number of triangles in a binary STL file.
std::size_t triangles(const std::string& path) { return (fs::file_size(path) - 84) / 50; }

const char* const several = R"(return { solids = {
  sharp(box({0,0,0},{1,1,1})):name("plate"),
  sharp(box({2,0,0},{3,1,1}) | box({2.5,0.5,0.5},{4,2,2})),
  sharp(box({5,0,0},{6,1,1})):name("Plate"),
  sharp(halfspace({0,1,0},-1)):name("floor"),
  sharp(box({7,0,0},{8,1,1})):name("../etc/a b\n"),
  sharp(box({9,0,0},{10,1,1})):name("plate"),
  sharp(box({11,0,0},{12,1,1}) & box({13,0,0},{14,1,1})):name("nothing"),
} })";

}  // namespace

TEST_CASE("mesh: %n in an output's name stands for each solid's name or number, made harmless and unique") {
    const Folder folder;
    write_file(folder / "s.lua", several);
    const Outcome outcome = run({"mesh", folder / "s.lua", "-o", folder / "%n.stl", "-o", folder / "p-%n-%n.obj"});
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err ==
          "deburr: solid 4 (floor) is unbounded and left out; --only 4 cuts it off and writes it\n"
          "deburr: solid 7 is not in the mesh: it is empty\n");
    CHECK(folder.names() == Names{"2.stl", "Plate-2.stl", "_._etc_a_b_n.stl", "p-2-2.mtl", "p-2-2.obj",
                                  "p-Plate-2-Plate-2.mtl", "p-Plate-2-Plate-2.obj", "p-_._etc_a_b_n-_._etc_a_b_n.mtl",
                                  "p-_._etc_a_b_n-_._etc_a_b_n.obj", "p-plate-3-plate-3.mtl", "p-plate-3-plate-3.obj",
                                  "p-plate-plate.mtl", "p-plate-plate.obj", "plate-3.stl", "plate.stl", "s.lua"});
    CHECK(triangles(folder / "plate.stl") == 12);
    CHECK(triangles(folder / "2.stl") > 12);
    CHECK(read_file(folder / "p-plate-3-plate-3.obj").find("\no plate\n") != std::string::npos);

    // A solid has the same file when it is written alone.
    const Folder alone;
    REQUIRE(run({"mesh", folder / "s.lua", "--only", "6", "-o", alone / "%n.stl"}).code == 0);
    CHECK(alone.names() == Names{"plate-3.stl"});
    CHECK(read_file(alone / "plate-3.stl") == read_file(folder / "plate-3.stl"));

    const Outcome twice = run({"mesh", folder / "s.lua", "-o", folder / "%n.obj", "-o", folder / "plate.obj"});
    CHECK(twice.code == 2);
    CHECK(twice.err.find("expected different files") != std::string::npos);
    // Nothing is written if one of the files cannot be written.
    fs::create_directory(alone / "b-plate-3.obj");
    CHECK(run({"mesh", folder / "s.lua", "-o", alone / "b-%n.obj"}).code == 1);
    CHECK(alone.names() == Names{"b-plate-3.obj", "plate-3.stl"});
}

TEST_CASE("mesh --only takes solids by name or number, and says which there are") {
    const Folder folder;
    write_file(folder / "s.lua", several);
    const auto mesh = [&](std::vector<std::string> only) {
        std::vector<std::string> words{"mesh", folder / "s.lua", "-o", folder / "a.stl"};
        for (const std::string& which : only) words.insert(words.end(), {"--only", which});
        return run(words);
    };
    const Outcome plates = mesh({"plate"});
    CHECK(plates.code == 0);
    CHECK(plates.err == "");
    CHECK(triangles(folder / "a.stl") == 24);
    CHECK(mesh({"Plate", "1", "plate"}).code == 0);
    CHECK(triangles(folder / "a.stl") == 36);
    const Outcome floor = mesh({"floor"});
    CHECK(floor.code == 0);
    CHECK(floor.err == "deburr: solid 4 is unbounded: its mesh is cut off\n");
    CHECK(triangles(folder / "a.stl") == 12);
    for (const char* wrong : {"flor", "0", "8", "", "1.5", "-1"}) {
        CAPTURE(wrong);
        const Outcome outcome = mesh({"plate", wrong});
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find("--only: expected a solid's name or number (1 plate, 2, 3 Plate, 4 floor, 5 ../etc/a "
                               "b\\n, 6 plate, 7 nothing), got '" +
                               std::string(wrong) + "'") != std::string::npos);
    }
    CHECK(mesh({"flor"}).err.find("did you mean floor?") != std::string::npos);
}

TEST_CASE("solids that are all unbounded are refused, and cut off when they are asked for") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { sharp(halfspace({0,1,0},-1)), sharp(halfspace({1,0,0},-1)) } }");
    const Outcome outcome = run({"mesh", folder / "s.lua", "-o", folder / "a.stl"});
    CHECK(outcome.code == 3);
    CHECK(outcome.err ==
          "deburr: solids 1, 2 are unbounded and left out; --only NAME or ID cuts one off and writes it\n");
    CHECK(run({"mesh", folder / "s.lua", "-o", folder / "a.stl", "--only", "2"}).code == 0);
}

TEST_CASE("mesh --recentre takes the middle of the solids that are written") {
    const Folder folder;
    write_file(folder / "s.lua", several);
    const Outcome outcome = run({"mesh", folder / "s.lua", "-o", folder / "a.stl", "--only", "1", "--recentre"});
    CHECK(outcome.err.find("deburr: --recentre: moved by (-0.50000000") == 0);
}
