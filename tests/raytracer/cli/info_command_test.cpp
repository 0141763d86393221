// What `deburr info` prints about a scene.
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/cli/scene_folder.hpp"

using namespace deburr::test;

TEST_CASE("info counts what a union places, however often it is more than can be laid out", "[slow]") {
    const SceneFolder place;
    // Each step doubles the row: 2²⁴ cubes side by side, with 100 million half-spaces.
    write_file(place.scene,
               "local a = sharp(cube()) for k = 0, 23 do a = a | a:translate(2^k, 0, 0) end\n"
               "return { solids = { a:rotate(90, {0, 0, 1}), ellipsoid{} | a } }");
    const Outcome o = run({"info", place.scene, "--json"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
    const auto j = nlohmann::json::parse(o.out);
    CHECK(j["solids"][0]["half_spaces"] == 6.0 * (1 << 24));
    CHECK(j["solids"][1]["half_spaces"] == 6.0 * (1 << 24));
    CHECK(j["solids"][1]["quadrics"] == 1);
    const auto bounds = j["solids"][0]["bounds"];
    CHECK(std::abs(bounds["lo"][0].get<double>() + 1) < 0.1);
    CHECK(std::abs(bounds["hi"][1].get<double>() - (1 << 24)) < 0.1);
    CHECK(std::abs(bounds["hi"][2].get<double>() - 1) < 0.1);
    // A mesh would need triangles for each cube.
    const Outcome mesh = run({"mesh", place.scene, "-o", place / "a.stl"});
    CHECK(mesh.code == 3);
    CHECK(mesh.err.find("deburr: expected a solid of at most 4000000 half-spaces") == 0);
}

TEST_CASE("info says what is in a scene") {
    const SceneFolder place;
    const Outcome o = run({"info", place.scene, "-D", "r=0.3"});
    CHECK(o.code == 0);
    CHECK(o.err.empty());
    for (const char* text : {"60x40", "r = 0.3", "solids        2", "half-spaces   12", "lights        1", "point",
                             "bounds        [-1, 2] x [-1, 1] x [-1, 2]"}) {
        CAPTURE(text, o.out);
        CHECK(o.out.find(text) != std::string::npos);
    }
    const auto j = nlohmann::json::parse(run({"info", "--json", place.scene}).out);
    CHECK(j["solids"].size() == 2);
    CHECK(j["half_spaces"] == 12);
    CHECK(j["quadrics"] == 0);
    CHECK(j["parameters"]["r"] == "0.1");
    CHECK(j["image"]["width"] == 60);
}

TEST_CASE("info counts round parts, and tells with render where they run on smoothly into other surfaces") {
    const SceneFolder place;
    const std::string scene = place / "s.lua";
    write_file(scene, R"(return { image = { width = 8, height = 8 }, solids = {
  rounded(0.1, box({0, 0, 0}, {2, 1, 1}) | cylinder{ from = {2, 0.5, 0}, to = {2, 0.5, 1}, radius = 0.5 }),
  rounded(0.1, cone{ from = {5, 0, 0}, to = {5, 1, 0}, radius = {1, 0} } & ~sphere{ center = {5, 0, 0}, radius = 0.3 }),
  sharp(torus{ center = {0, 5, 0}, radius = 1, tube = 0.2 }) } })");
    const Outcome o = run({"info", scene});
    CAPTURE(o.out);
    CHECK(o.code == 0);
    const std::string warning =
        "s.lua:2: a round part runs on smoothly into another surface and bulges there by 0.016, 0.16 of the radius, at "
        "(2, 1, ";
    for (const std::string& text : {std::string("half-spaces   9"), std::string("round parts   4"),
                                    std::string("8 half-spaces 1 round parts in [0, 2.5] x"), warning}) {
        CAPTURE(text);
        CHECK(o.out.find(text) != std::string::npos);
    }
    CHECK(o.out.find("s.lua:3: a round part") == std::string::npos);
    CHECK(run({"render", scene, "--spp", "1", "-o", place / "a.png"}).err.find(warning) != std::string::npos);
}

TEST_CASE("info rounds away what a box reaches too far, and minus zero") {
    const SceneFolder place;
    const std::string scene = place / "s.lua";
    const auto bounds = [&](const std::string& solid) {
        write_file(scene, "return { solids = { " + solid + " } }");
        const std::string out = run({"info", scene}).out;
        const std::size_t at = out.find(" in [");
        return out.substr(at + 4, out.find('\n', at) - at - 4);
    };
    CHECK(bounds("cube()") == "[0, 1] x [0, 1] x [0, 1]");
    CHECK(bounds("cube():translate(0, 0, -1)") == "[0, 1] x [0, 1] x [-1, 0]");
    CHECK(bounds("halfspace({0, 1, 0}, 0)") == "[-inf, inf] x [-inf, 0] x [-inf, inf]");
    CHECK(bounds("halfspace({0, 1, 0}, 1e-9)") == "[-inf, inf] x [-inf, 1e-09] x [-inf, inf]");
    CHECK(bounds("box({0, -0.015, 0}, {110, 0, 83.185})") == "[0, 110] x [-0.015, 0] x [0, 83.185]");
    CHECK(bounds("box({0, 1e-7, -3e-7}, {1e-6, 2e-6, 0})") == "[0, 1e-06] x [1e-07, 2e-06] x [-3e-07, 0]");
    CHECK(bounds("box({0, -1e12, 0}, {3e14, 123456, 7})") == "[0, 3e+14] x [-1e+12, 0] x [0, 0]");
    CHECK(bounds("ellipsoid{ center = {0, 2, 0}, radius = 2 }") == "[-2, 2] x [0, 4] x [-2, 2]");
    const auto j = nlohmann::json::parse(run({"info", "--json", scene}).out);
    CHECK(j["solids"][0]["bounds"]["lo"].dump() == "[-2.0,0.0,-2.0]");
}

TEST_CASE("info shows a camera without what rounding leaves") {
    const SceneFolder place;
    const std::string scene = place / "s.lua";
    const auto camera = [&](const std::string& fields, const std::vector<std::string>& options = {}) {
        write_file(scene, "return { solids = { cube() }, camera = " + fields + " }");
        std::vector<std::string> call{"info", scene};
        call.insert(call.end(), options.begin(), options.end());
        const std::string out = run(call).out;
        const std::size_t at = out.find("eye ");
        return out.substr(at, out.find("; fov", at) - at);
    };
    CHECK(camera("{ eye = {3, 1e-17, -0.0}, target = {0, 0, -1e-9} }") == "eye 3 0 0; target 0 0 0; up 0 1 0");
    CHECK(camera("{ eye = {3e-9, 1e-12, 0}, target = {0, 0, -1e-9} }") ==
          "eye 3e-09 1e-12 0; target 0 0 -1e-09; up 0 1 0");
    CHECK_THAT(camera("frame{}", {"--from", "0,-1,0"}), Catch::Matchers::EndsWith("up 0 0 1"));
    write_file(scene, "return { solids = { cube() }, camera = { eye = {3, -0.0, 0} } }");
    CHECK(nlohmann::json::parse(run({"info", "--json", scene}).out)["camera"]["eye"].dump() == "[3.0,0.0,0.0]");
}

TEST_CASE("no name and no text of a scene reaches the terminal as a control character") {
    const SceneFolder place;
    const std::string scene = place / "a\33[31m.lua", title = "\33]0;owned\7\302\233";
    write_file(scene,
               "print('\\27]0;printed\\7', 'a\\nb') local s = '\\27]0;owned\\7\\194\\155'\n"
               "return { solids = { rounded(param(s, 0.1), cube()):name(s) } }");
    const auto is_clean = [](const std::string& text) {
        return text.find_first_of("\33\7\177") == std::string::npos && text.find("\302\233") == std::string::npos;
    };
    const Outcome info = run({"info", scene});
    CHECK(info.code == 0);
    CHECK(is_clean(info.out));
    CHECK(is_clean(info.err));
    CHECK(info.err == "\\x1b]0;printed\\x07\ta\nb\n");
    CHECK(info.out.find("scene         ") == 0);
    CHECK(info.out.find("a\\x1b[31m.lua\n") != std::string::npos);
    CHECK(info.out.find("\\x1b]0;owned\\x07\\u{9b}: 6 half-spaces") != std::string::npos);
    CHECK(info.out.find("parameter     \\x1b]0;owned") != std::string::npos);
    const Outcome json = run({"info", "--json", scene});
    CHECK(is_clean(json.out));
    CHECK(nlohmann::json::parse(json.out)["solids"][0]["name"] == title);
    const Outcome mesh = run({"mesh", scene, "--stats", "-q"});
    CHECK(mesh.code == 0);
    CHECK(is_clean(mesh.out));
    write_file(scene, "error('\\27[2J')");
    const Outcome wrong = run({"info", scene});
    CHECK(wrong.code == 2);
    CHECK(is_clean(wrong.err));
    CHECK(wrong.err.find("a\\x1b[31m.lua:1: \\x1b[2J\n") != std::string::npos);
    CHECK(is_clean(run({"info", "\33[31m.lua"}).err));
    CHECK(is_clean(run({"\33[31m"}).err));
}

TEST_CASE("info says of a model its triangles, its faces, its volume and its radius") {
    const Folder folder;
    const std::string file = folder / "box.off";
    write_file(file,
               "OFF\n8 12 0\n0 0 0\n3 0 0\n3 2 0\n0 2 0\n0 0 1\n3 0 1\n3 2 1\n0 2 1\n"
               "3 2 1 0\n3 3 2 0\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n"
               "3 3 0 4\n3 3 4 7\n");
    const Outcome text = run({"info", file, "--round", "0.25"});
    CHECK(text.code == 0);
    CHECK(text.out.find("triangles     12\n") != std::string::npos);
    CHECK(text.out.find(
              "box: 12 triangles on 6 faces, volume 6 when sharp, rounded by 0.25, in [0, 3] x [0, 2] x [0, 1]") !=
          std::string::npos);
    const auto j = nlohmann::json::parse(run({"info", "--json", file}).out);
    CHECK(j["triangles"] == 12);
    CHECK(j["solids"][0]["models"] ==
          nlohmann::json::parse(R"({"triangles": 12.0, "faces": 6.0, "sharp_volume": 6.0, "radius": 0.0})"));
}
