// `deburr mesh --faces`: at most this number of triangles, reached by decimating or by refining.
#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "polygonizer/random_part.hpp"
#include "raytracer/mesh/face_count.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

namespace {

struct Made {
    Outcome outcome;
    nlohmann::json mesh;  // statistics of the mesh
    double faces() const { return mesh["triangles"]; }
};

Made mesh(const std::string& scene, std::vector<std::string> more) {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { " + scene + " } }");
    std::vector<std::string> words{"mesh", folder / "s.lua", "--stats-json", folder / "a.json"};
    words.insert(words.end(), more.begin(), more.end());
    Made made{run(words), {}};
    if (made.outcome.code == 0) made.mesh = nlohmann::json::parse(read_file(folder / "a.json"))["mesh"];
    return made;
}

// Three solids that have 1,500 triangles at their default tolerances.
const char* const three_solids =
    "rounded(0.1, cube() & ~box({0.3,0.3,-1},{0.7,0.7,2})), rounded(0.2, box({2,0,0},{4,1,1})), "
    "rounded(0.05, prism({{0.5,0}, {0.25,0.43}, {-0.25,0.43}, {-0.5,0}, {-0.25,-0.43}, {0.25,-0.43}}, 3, 4))";

}  // namespace

TEST_CASE("mesh --faces thins out what has more triangles, and says how far that is from the surface") {
    for (const int faces : {1000, 400}) {
        CAPTURE(faces);
        const Made made = mesh(three_solids, {"--faces", std::to_string(faces)});
        INFO(made.outcome.err);
        REQUIRE(made.outcome.code == 0);
        CHECK(made.faces() <= faces);
        CHECK(made.faces() >= faces - 2 * 3);
        CHECK(made.mesh["manifold"] == true);
        CHECK(made.mesh["inverted"] == 0);
        const std::string line = "deburr: --faces: the mesh of solid ", up_to = " is up to ";
        REQUIRE(made.outcome.err.rfind(line, 0) == 0);
        const double said = std::stod(made.outcome.err.substr(made.outcome.err.find(up_to) + up_to.size()));
        CHECK(said > 0.0025);  // the least of the solids' tolerances
        CHECK(said < 0.2);
        CHECK(std::count(made.outcome.err.begin(), made.outcome.err.end(), '\n') == 1);
    }
}

TEST_CASE("mesh --faces makes finer what has fewer triangles, and keeps the tolerance", "[slow]") {
    const Made coarse = mesh(three_solids, {}), fine = mesh(three_solids, {"--faces", "8000"});
    CHECK(fine.outcome.err == "");
    REQUIRE(fine.outcome.code == 0);
    CHECK(coarse.faces() < 4000);
    CHECK(fine.faces() <= 8000);
    CHECK(fine.faces() >= 7200);
    CHECK(fine.mesh["triangle_distance"]["max"] < coarse.mesh["triangle_distance"]["max"]);
    CHECK(fine.mesh["manifold"] == true);
}

TEST_CASE("mesh --faces says when there are no fewer triangles, or no more, to be had") {
    const Made few = mesh("sharp(cube())", {"--faces", "11"}), many = mesh("sharp(cube())", {"--faces", "1000"}),
               right = mesh("sharp(cube())", {"--faces", "12"});
    for (const Made* made : {&few, &many, &right}) {
        REQUIRE(made->outcome.code == 0);
        CHECK(made->faces() == 12);
    }
    CHECK(few.outcome.err == "deburr: --faces: expected at most 11 triangles, and 12 are the fewest found\n");
    CHECK(many.outcome.err == "deburr: --faces: expected up to 1000 triangles, and 12 are the most found\n");
    CHECK(right.outcome.err == "");
}

TEST_CASE("mesh --faces keeps the cells of octree and marching cubes even", "[slow]") {
    const std::string solid = "rounded(0.1, cube()) - sharp(box({0.5,0.5,0.5},{2,2,2}))";
    for (const char* method : {"octree", "marching-cubes"})
        for (const int faces : {400, 3001, 20000}) {
            CAPTURE(method, faces);
            const Made made = mesh(solid, {"--faces", std::to_string(faces), "--method", method});
            CHECK(made.outcome.err == "");
            REQUIRE(made.outcome.code == 0);
            CHECK(made.faces() <= faces);
            CHECK(made.faces() >= 0.99 * faces - 2);
            CHECK(made.mesh["manifold"] == true);
        }
}

TEST_CASE("mesh --faces thins out free forms") {
    const Made made = mesh("ellipsoid{center={0,0,0}, radii={1,0.5,0.7}}", {"--faces", "1500"});
    INFO(made.outcome.err);
    REQUIRE(made.outcome.code == 0);
    CHECK(made.faces() == 1500);
    CHECK(made.mesh["manifold"] == true);
    CHECK(made.mesh["triangle_distance"]["max"] < 0.01);
}

TEST_CASE("a mesh of a wanted number of triangles does not depend on the number of threads", "[threads]") {
    const Folder folder;
    write_file(folder / "s.lua", std::string("return { solids = { ") + three_solids + " } }");
    for (const char* threads : {"1", "4"})
        REQUIRE(run({"mesh", folder / "s.lua", "-q", "--faces", "500", "--threads", threads, "-o",
                     folder / (std::string(threads) + ".ply")})
                    .code == 0);
    CHECK(read_file(folder / "1.ply") == read_file(folder / "4.ply"));
}

TEST_CASE("Random parts of half or twice of their triangles, or of the fewest, are closed and right") {
    const int count = std::getenv("DEBURR_STRESS") ? std::atoi(std::getenv("DEBURR_STRESS")) : 12;
    int reached = 0, expected = 0;
    for (int seed = 1; seed <= count; ++seed) {
        CAPTURE(seed);
        deburr::Scene scene;
        deburr::RandomPart random(seed);
        scene.solids.push_back(random.solid());
        expected += random.radius() > 0 ? 2 : 1;  // sharp parts need all their triangles
        deburr::MeshSettings settings;
        settings.triage_tolerance_in_radii = deburr::default_tolerance_in_radii;
        const std::size_t all = mesh_scene(scene, settings).mesh.triangles.size();
        for (const std::size_t faces : {std::size_t(12), all / 2, 2 * all}) {
            CAPTURE(all, faces);
            settings.check = true;
            const deburr::SceneMesh mesh = mesh_scene_with_faces(scene, settings, faces);
            REQUIRE(mesh.checks.size() == 1);
            CHECK(mesh.checks[0].faults() == 0);
            CHECK(topology(mesh.mesh).manifold());
            reached += mesh.mesh.triangles.size() <= faces;
        }
    }
    CHECK(reached >= expected);
}
