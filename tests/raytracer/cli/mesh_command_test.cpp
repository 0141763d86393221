// `deburr mesh`, as a user calls it.
#include <signal.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include <algorithm>

#include "catch.hpp"
#include "polygonizer/admesh.hpp"
#include "polygonizer/welded.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;
namespace fs = std::filesystem;

TEST_CASE("mesh writes every format, and says that the mesh is closed") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.1, cube()) - sharp(box({0.5,0.5,0.5},{2,2,2})) } }");
    const Outcome outcome =
        run({"mesh", folder / "s.lua", "-o", folder / "a.obj", "-o", folder / "a.ply", "-o", folder / "a.stl", "-o",
             folder / "a.glb", "-o", folder / "a.ase", "-o", folder / "a.3mf", "--stats-json", folder / "a.json"});
    CHECK(without_progress(outcome.err) == "");
    REQUIRE(outcome.code == 0);
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.glb", "a.ase", "a.3mf"})
        CHECK(fs::file_size(folder / name) > 1000);
    const nlohmann::json j = nlohmann::json::parse(read_file(folder / "a.json"));
    CHECK(j["mesh"]["manifold"] == true);
    CHECK(j["mesh"]["inverted"] == 0);
    CHECK(j["mesh"]["vertex_distance_max"] < 1e-6);
}

TEST_CASE("Parts and solids that touch are closed 2-manifolds in an STL, whose vertices a reader joins by position",
          "[slow]") {
    const Folder folder;
    for (const char* solids :
         {"sharp(cube() + cube():translate(1,1,0))", "rounded(0.1, cube() + cube():translate(1,1,1))",
          "sharp(cube()), sharp(cube():translate(0,0,1)), rounded(0.2, cube():translate(1,0,0))",
          "sharp(cube() + cube():translate(1,1,0)):scale(1000)",
          "sharp(cube() + cube():translate(1,1,0)):scale(0.001)"})
        for (const char* method : {"triage", "marching-cubes"}) {
            CAPTURE(solids, method);
            write_file(folder / "s.lua", "return { solids = { " + std::string(solids) + " } }");
            REQUIRE(run({"mesh", folder / "s.lua", "-q", "--method", method, "-o", folder / "a.stl"}).code == 0);
            const deburr::Topology t = topology(deburr::welded_stl(read_file(folder / "a.stl")));
            CHECK(t.manifold());
            CHECK(t.triangles > 0);
        }
}

TEST_CASE("mesh by octree: cells, hard edges and a number of faces as asked") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.1, cube()) - sharp(box({0.5,0.5,0.5},{2,2,2})) } }");
    const auto mesh = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"mesh",   folder / "s.lua", "--method",
                                       "octree", "--stats-json",   folder / "a.json"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run(words);
        CHECK(without_progress(outcome.err) == "");
        REQUIRE(outcome.code == 0);
        const nlohmann::json j = nlohmann::json::parse(read_file(folder / "a.json"));
        CHECK(j["mesh"]["manifold"] == true);
        CHECK(j["mesh"]["inverted"] == 0);
        CHECK(j["mesh"]["vertex_distance_max"] < 1e-6);
        return j;
    };
    const nlohmann::json by_edge = mesh({"--edge", "0.05"});
    CHECK(by_edge["octree"]["edge"] == 0.05);
    CHECK(by_edge["octree"]["hard_points"] > 40);
    CHECK(by_edge["mesh"]["vertex_normal_degrees"]["mean"] < 5);
    CHECK(mesh({"--level", "4"})["mesh"]["triangles"] < by_edge["mesh"]["triangles"]);
    CHECK(mesh({"--edge", "0.05", "--hard-edges", "180"})["octree"]["hard_points"] == 0);
    for (const char* method : {"octree", "marching-cubes"}) {
        const Outcome outcome =
            run({"mesh", folder / "s.lua", "--method", method, "--faces", "20000", "--stats-json", folder / "a.json"});
        CHECK(outcome.code == 0);
        const double faces = nlohmann::json::parse(read_file(folder / "a.json"))["mesh"]["triangles"];
        CHECK(std::abs(faces - 20000) < 200);
    }
}

TEST_CASE("mesh takes free forms by octree, and other solids by triage, unless told") {
    const Folder folder;
    write_file(folder / "s.lua",
               "return { solids = { ellipsoid{center={0,0,2}, radii={1,0.5,0.7}}, rounded(0.1, cube()) } }");
    const Outcome outcome = run({"mesh", folder / "s.lua", "-o", folder / "a.ase", "--stats-json", folder / "a.json"});
    CHECK(without_progress(outcome.err) == "");
    REQUIRE(outcome.code == 0);
    const nlohmann::json j = nlohmann::json::parse(read_file(folder / "a.json"));
    CHECK(j["method"] == "octree, triage");
    CHECK(j["mesh"]["manifold"] == true);
    CHECK(j["mesh"]["vertex_distance_max"] < 1e-6);
    CHECK(run({"mesh", folder / "s.lua", "-o", folder / "b.obj", "--method", "triage"}).code == 3);
}

TEST_CASE("admesh finds nothing to repair in the STL of any scene", "[slow]") {
    if (!deburr::has_admesh()) {
        WARN("admesh is not installed");
        return;
    }
    const Folder folder;
    int scenes = 0;
    for (const auto& entry : fs::directory_iterator(DEBURR_SOURCE_DIR "/scenes")) {
        const std::string name = entry.path().stem().string();
        // One solid of many quadratic forms takes half a minute. The hole punch has the same kinds of parts as the
        // staplers.
        if (entry.path().extension() != ".lua" || name == "convolution" || name == "staplers") continue;
        CAPTURE(name);
        REQUIRE(run({"mesh", entry.path().string(), "-q", "-o", folder / "a.stl"}).code == 0);
        CHECK(deburr::admesh_repairs(folder / "a.stl", folder / "log") == "");
        ++scenes;
    }
    CHECK(scenes > 10);
}

TEST_CASE("mesh refuses what it does not know, and writes nothing") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.1, cube()) } }");
    for (const std::vector<std::string>& words : {std::vector<std::string>{"-o", "a.xyz"},
                                                  {"-o", "a.obj", "--method", "magic"},
                                                  {"-o", "a.obj", "--tolerance", "-1"},
                                                  {"-o", "a.obj", "--grid", "0.1"},
                                                  {"-o", "a.obj", "--edge", "0.1"},
                                                  {"-o", "a.obj", "--method", "octree", "--level", "13"},
                                                  {"-o", "a.obj", "--method", "octree", "--edge", "0"},
                                                  {"-o", "a.obj", "--method", "octree", "--edge", "1", "--level", "3"},
                                                  {"-o", "a.obj", "--method", "octree", "--hard-edges", "200"},
                                                  {"-o", "a.obj", "--faces", "0"},
                                                  {"-o", "a.3mf", "--unit", "parsec"},
                                                  {"-o", "a.obj", "--up", "x"},
                                                  {"-o", "a.obj", "--only", "2"},
                                                  {"-o", "a-%n"},
                                                  {"-o", "a.obj", "--unit", "inch"},
                                                  {}}) {
        std::vector<std::string> all{"mesh", folder / "s.lua"};
        for (const std::string& word : words) all.push_back(word.starts_with("a.") ? folder / word : word);
        CHECK(run(all).code == 2);
    }
    CHECK(folder.names() == std::vector<std::string>{"s.lua"});
}

// The tolerance is 0.03 r, but a ray that grazes a rounded edge meets it that much farther along the ray; the radius
// 0.5 of variable_rounding is as large as the object. Free forms have no radius to follow: their mesh is as fine as a
// grid of 64 cells, and a lamp mirrored in it has another outline.
TEST_CASE("Every scene's mesh looks like its implicit surface", "[slow]") {
    const auto looks_alike = [](const std::string& scene, const std::string& rmse) {
        CAPTURE(scene);
        const Folder folder;
        const Outcome outcome =
            run({"compare", scene, "--size", "300x190", "--max-missed", "0.8", "--max-distance", "0.1", "--max-rmse",
                 rmse, "--json", folder / "a.json", "-o", folder / "difference.exr"});
        INFO(outcome.err << outcome.out);
        CHECK(outcome.code == 0);
        CHECK(fs::exists(folder / "difference.exr"));
    };
    for (const auto& entry : fs::directory_iterator(DEBURR_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".lua") continue;
        // The hole punch has the same kinds of parts as the staplers and takes a tenth of the time. The polished balls
        // of the bearing and the flutes of the tap mirror differently with facets; their parts are tested below.
        const std::string stem = entry.path().stem();
        if (stem == "staplers" || stem == "bearing" || stem == "tap_and_die") continue;
        const auto info = nlohmann::json::parse(run({"info", "--json", entry.path().string()}).out);
        // Highlights are sharper than facets, also on the tips of the star.
        const std::string name = entry.path().stem().string();
        looks_alike(entry.path().string(), info["quadrics"] > 0 ? "0.15" : name == "convolution" ? "0.05" : "0.03");
    }
    const Folder folder;
    write_file(folder / "round.lua", R"(
local function rod(x, z, y0, y1, r) return cylinder{ from = {x, y0, z}, to = {x, y1, z}, radius = r } end
local stand = box({-1, 0, -1}, {1, 0.7, 1}) & ~rod(0, 0, -1, 2, 0.5)
for x = -0.7, 1, 1.4 do for z = -0.7, 1, 1.4 do stand = stand | rod(x, z, 0.1, 1.4, 0.2) end end
return { solids = { rounded(0.1, stand),
                    rounded(0.1, cone{ from = {-3, 0, 0}, to = {-3, 2, 0}, radius = {1, 0.2} }),
                    rounded(0.1, rod(3, 0, 0, 1, 1) & ~torus{ center = {3, 0.5, 0}, radius = 1, tube = 0.3 }),
                    rounded(0.1, sphere{ center = {6, 1, 0} } & ~cylinder{ from = {6, 1, -2}, to = {6, 1, 2}, radius = 0.4 }) },
         image = { spp = 1 } })");
    looks_alike(folder / "round.lua", "0.03");
}

TEST_CASE("a mesh does not depend on the number of threads", "[threads]") {
    const Folder folder;
    write_file(
        folder / "s.lua",
        "local all = {}\nfor k = 1, 12 do all[k] = (rounded(0.02 * k, cube()) - sharp(box({0.5,0.5,0.5},{2,2,2}))"
        "):translate(2 * k, 0, 0) end\nall[13] = sharp(halfspace({0,1,0}, -1))\nreturn { solids = all }");
    for (const char* threads : {"1", "4"}) {
        const Outcome outcome =
            run({"mesh", folder / "s.lua", "-o", folder / (std::string(threads) + ".ply"), "--threads", threads});
        REQUIRE(outcome.code == 0);
        CHECK(without_progress(outcome.err) ==
              "deburr: solid 13 is unbounded and left out; --only 13 cuts it off and writes it\n");
    }
    CHECK(read_file(folder / "1.ply") == read_file(folder / "4.ply"));
}

TEST_CASE("one large solid has the same mesh by any number of threads", "[threads][slow]") {
    const Folder folder;
    // The mesh has more than one block of triangles before decimation.
    write_file(
        folder / "s.lua",
        "local plate = box({0,0,0}, {5,0.3,4})\n"
        "for i = 0, 4 do for k = 0, 3 do\n"
        "  local hole = {}\n"
        "  for j = 1, 12 do local a = j*math.pi/6; hole[j] = {i+0.5+0.3*math.cos(a), k+0.5+0.3*math.sin(a)} end\n"
        "  plate = plate & ~prism(hole, -1, 2)\nend end\n"
        "return { solids = { rounded(0.04, plate) } }");
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = folder / (std::string(threads) + ".ply");
        REQUIRE(run({"mesh", folder / "s.lua", "-o", out, "--threads", threads, "-q"}).code == 0);
        if (first.empty()) first = read_file(out);
        CHECK(read_file(out) == first);
    }
}

TEST_CASE("the first interrupt of a mesh ends it and writes nothing", "[slow]") {
    const Folder folder;
    // One solid is finished quickly, all of them are not.
    write_file(folder / "s.lua",
               "local all = {}\nfor k = 1, 20000 do all[k] = rounded(0.1, cube()):translate(2 * k, 0, 0) end\n"
               "return { solids = all }");
    const std::string out = GENERATE("mesh a.ply", "render a.png", "compare a.png");
    const std::string command = out.substr(0, out.find(' ')), file = folder / out.substr(out.find(' ') + 1);
    std::vector<std::string> words{command, folder / "s.lua", "-o", file, "--tolerance", "0.0001"};
    if (command == "render") words.insert(words.end(), {"--via", "triage", "-v"});
    Call call(words);
    if (command == "compare")
        std::this_thread::sleep_for(std::chrono::seconds(2));
    else
        REQUIRE(call.says(command == "mesh" ? " left" : " 20000 solids"));
    call.send(SIGINT);
    const Outcome outcome = call.wait();
    CAPTURE(out, outcome.err);
    CHECK(outcome.code == 130);
    CHECK(outcome.err.find("interrupted: nothing is written") != std::string::npos);
    CHECK_FALSE(fs::exists(file));
}

TEST_CASE("an interrupt ends every method in the middle of a solid") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.1, cube()) } }");
    const std::string method = GENERATE("octree --edge", "marching-cubes --grid");
    Call call({"mesh", folder / "s.lua", "-o", folder / "a.ply", "--method", method.substr(0, method.find(' ')),
               method.substr(method.find(' ') + 1), "0.001"});
    std::this_thread::sleep_for(std::chrono::seconds(1));
    call.send(SIGINT);
    const Outcome outcome = call.wait();
    CAPTURE(method, outcome.err);
    CHECK(outcome.code == 130);
    CHECK_FALSE(fs::exists(folder / "a.ply"));
}

TEST_CASE("mesh writes nothing wrong: a lost part is said with its place, and --force or --no-check writes it") {
    const Folder folder;
    // With cells of this size no method could see the cube.
    write_file(folder / "s.lua",
               "return { solids = {\n  rounded(0.05, box({0,0,0},{4,1,4}) | box({6,0.4,1.4},{6.3,0.7,1.7})) } }");
    const auto mesh = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"mesh", folder / "s.lua", "--method", "marching-cubes", "--grid", "1.5",
                                       "-o",   folder / "a.stl"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    };
    const Outcome outcome = mesh({"--stats-json", folder / "a.json"});
    CHECK(outcome.code == 1);
    CHECK(outcome.err.find("s.lua:2: solid 1: ") != std::string::npos);
    CHECK(outcome.err.find("not in the mesh, the first at (6.") != std::string::npos);
    CHECK(!fs::exists(folder / "a.stl"));
    const nlohmann::json check = nlohmann::json::parse(read_file(folder / "a.json"))["check"];
    CHECK(check["faults"] > 0);
    CHECK(check["made_again"] == 1);
    CHECK(check["solids"][0]["missing"]["place"][0] > 6);
    CHECK(mesh({"--force"}).code == 0);
    CHECK(fs::exists(folder / "a.stl"));
    fs::remove(folder / "a.stl");
    const Outcome unchecked = mesh({"--no-check"});
    CHECK(unchecked.code == 0);
    CHECK(without_progress(unchecked.err) == "");
    CHECK(fs::exists(folder / "a.stl"));
}

TEST_CASE("A small radius far away is more than an STL can hold: this is said, and --recentre helps") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.001, cube()):translate(1000,2000,-3000) } }");
    const Outcome outcome = run({"mesh", folder / "s.lua", "-o", folder / "a.stl", "-o", folder / "a.ply"});
    CHECK(outcome.code == 0);
    CHECK(outcome.err.find("a.stl: single precision has steps of 0.00024 at coordinates up to 3000") !=
          std::string::npos);
    CHECK(outcome.err.find("--recentre") != std::string::npos);
    CHECK(outcome.err.find("a.ply") == std::string::npos);
    const Outcome moved = run({"mesh", folder / "s.lua", "--recentre", "-o", folder / "b.stl"});
    CHECK(moved.code == 0);
    CHECK(moved.err.find("moved by (-1000.5, -2000.5, 2999.5)") != std::string::npos);
    CHECK(moved.err.find("single precision") == std::string::npos);
    const deburr::Mesh mesh = deburr::welded_stl(read_file(folder / "b.stl"));
    CHECK(topology(mesh).manifold());
    CHECK(bounding_box(mesh).lo == deburr::Vec3(-0.5));
    CHECK(bounding_box(mesh).hi == deburr::Vec3(0.5));
}

TEST_CASE("a surface that passes too many cells of an octree is refused within seconds, whatever stands beside it") {
    const Folder folder;
    const std::string scene = folder / "s.lua";
    // compare cuts the eight unbounded slabs off at ten thousand sizes, and their radius is far below the octree's
    // cells.
    write_file(scene, R"(
        local slabs
        for i = -4, 3 do
            local slab = halfspace({0, 1, 0}, 1000 * i + 500) * halfspace({0, -1, 0}, -1000 * i)
            slabs = slabs and slabs | slab or slab
        end
        return { solids = { rounded(0.1, cube()), rounded(0.5, slabs) - ellipsoid{ radius = 2 } } })");
    const Outcome outcome = run({"compare", scene, "--size", "4x3", "-q"});
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.err, Catch::Matchers::StartsWith("deburr: octree: the surface of solid 2, ") &&
                                Catch::Matchers::Contains(" passes more than 1000000 cells of "));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}
