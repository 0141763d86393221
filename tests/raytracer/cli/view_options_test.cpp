// --frame and --from, and the camera of a scene that has none.
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

namespace {

nlohmann::json camera_of(const std::vector<std::string>& words) {
    std::vector<std::string> all = {"info", "--json"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run(all);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return nlohmann::json::parse(outcome.out)["camera"];
}

}  // namespace

TEST_CASE("--frame moves the scene's camera without turning it, and --from turns it") {
    const Folder folder;
    const std::string scene = folder / "s.lua";
    write_file(scene,
               "return { camera = { eye = {0, 0, 1}, target = {0, 0, 0}, fov = 20 }, "
               "solids = { box({1000, 0, 0}, {1010, 10, 10}), halfspace({0, 1, 0}, 0) } }");
    CHECK(camera_of({scene})["eye"] == nlohmann::json({0, 0, 1}));
    const auto framed = camera_of({scene, "--frame"});
    CHECK(framed["fov"] == 20);
    CHECK(framed["eye"][0].get<double>() == Approx(1005));
    CHECK(framed["eye"][1].get<double>() == Approx(5));
    CHECK(framed["eye"][2].get<double>() > 20);
    const auto turned = camera_of({scene, "--from", "-1,0,0", "--size", "100x100"});
    CHECK(turned["fov"] == 20);
    CHECK(turned["eye"][0].get<double>() < 980);
    CHECK(turned["eye"][2].get<double>() == Approx(5));
    CHECK(run({"info", scene, "--from", "0,0,0"}).err ==
          "deburr: --from: expected X,Y,Z, not all 0, for example 1,0.5,2, got '0,0,0'\n");
}

TEST_CASE("a scene without a camera shows the whole model in any picture") {
    const Folder folder;
    const std::string scene = folder / "s.lua";
    write_file(scene, "return { solids = { box({-300, 0, -200}, {900, 100, 400}) } }");
    const auto wide = camera_of({scene, "--size", "800x100"}), tall = camera_of({scene, "--size", "100x800"});
    CHECK(wide["eye"] != tall["eye"]);
}
