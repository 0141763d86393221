// SIGINT and SIGTERM, as sent by a user or a scheduler.
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/cli/scene_folder.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

namespace {

// A plate with 6 × 6 holes of 16 sides; meshing it takes minutes.
const char* const plate = R"(
local holes
for i = 1, 6 do for j = 1, 6 do
  local p = {}
  for k = 0, 15 do local a = 2 * math.pi * (k + 0.5) / 16; p[#p + 1] = {15 * i + 2.5 * math.cos(a), 15 * j + 2.5 * math.sin(a)} end
  local h = prism(p, -1, 9)
  holes = holes and (holes | h) or h
end end
return { solids = { rounded(0.5, box({0, 0, 0}, {105, 8, 105}) & ~holes) } }
)";

// So many solids that every phase takes long.
const char* const blocks = R"(
local all = {}
for i = 1, 100000 do all[i] = rounded(0.1, box({i, 0, 0}, {i + 0.6, 0.6, 0.6}) + box({i, 2, 0}, {i + 0.6, 3, 0.6})) end
return { solids = all }
)";

int incomplete(const std::string& path) { return read_back(path).attribute<int>("deburr.incomplete"); }

}  // namespace

TEST_CASE("the first interrupt saves what there is, marked incomplete") {
    for (const int signal : {SIGINT, SIGTERM}) {
        const SceneFolder place;
        // A tile is finished quickly, the whole picture is not.
        Call call({"render", place.scene, "-o", place / "a.exr", "-q", "--size", "600x600", "--spp", "1000",
                   "--stats-json", place / "s.json"});
        pause_for(2);  // tracing has begun by then, even on a busy machine
        call.send(signal);
        const Outcome o = call.wait();
        CAPTURE(o.err);
        CHECK(o.code == 130);
        CHECK(o.err.find("the picture is marked incomplete") != std::string::npos);
        CHECK(place.names() == Words{"a.exr", "cube.lua", "s.json"});
        CHECK(incomplete(place / "a.exr") == 1);
        CHECK(nlohmann::json::parse(read_file(place / "s.json"))["complete"] == false);
    }
}

TEST_CASE("SIGTERM any number of times does not lose the picture, nor does one SIGINT among them") {
    for (const bool mixed : {false, true}) {
        const SceneFolder place;
        Call call({"render", place.scene, "-o", place / "a.exr", "-q", "--size", "600x600", "--spp", "1000"});
        pause_for(2);
        for (int i = 0; i < 40; ++i) {
            call.send(mixed && i == 20 ? SIGINT : SIGTERM);
            pause_for(0.005);
        }
        CHECK(call.wait().code == 130);
        CHECK(incomplete(place / "a.exr") == 1);
        CHECK(place.names() == Words{"a.exr", "cube.lua"});
    }
}

TEST_CASE("the second SIGINT ends at once and leaves nothing") {
    const SceneFolder place;
    // Tiles take very long, and so does compressing the picture.
    Call call({"render", place.scene, "-o", place / "a.exr", "-v", "--size", "7000x7000", "--aov", "P,N"});
    REQUIRE(call.says(" half-spaces"));
    pause_for(2);
    call.send(SIGINT);
    REQUIRE(call.says("another Ctrl-C stops at once"));
    CHECK(call.running());
    call.send(SIGINT);
    CHECK(call.wait().code == 130);
    CHECK(place.names() == Words{"cube.lua"});
}

TEST_CASE("an interrupted picture has the samples that all pixels have, and ends within a second") {
    const SceneFolder place;
    Call call({"render", place.scene, "-o", place / "a.exr", "-v", "--spp", "1048576"});
    REQUIRE(call.says(" half-spaces"));
    pause_for(0.5);
    const auto start = std::chrono::steady_clock::now();
    call.send(SIGTERM);
    const Outcome o = call.wait();
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
    CHECK(o.code == 130);
    CAPTURE(o.err);
    const std::size_t at = o.err.find("interrupted after ");
    REQUIRE(at != std::string::npos);
    CHECK(o.err.find(" of 1048576 samples of all pixels: the picture is marked incomplete\n") != std::string::npos);
    CHECK(incomplete(place / "a.exr") == 1);
    // Each pixel has exactly as many samples as the message says.
    const std::string samples = std::to_string(std::stoi(o.err.substr(at + std::string("interrupted after ").size())));
    REQUIRE(run({"render", place.scene, "-o", place / "b.exr", "-q", "--spp", samples}).code == 0);
    CHECK(read_back(place / "a.exr").values == read_back(place / "b.exr").values);
}

TEST_CASE("--write-every writes what all pixels have, and the picture at the end is the same", "[slow]") {
    const SceneFolder place;
    Call call({"render", place.scene, "-o", place / "a.exr", "-q", "--size", "300x300", "--spp", "4000",
               "--write-every", "0.2"});
    for (int i = 0; i < 1000 && !std::filesystem::exists(place / "a.exr"); ++i) pause_for(0.02);
    CHECK(call.running());
    CHECK(incomplete(place / "a.exr") == 1);
    call.send(SIGTERM);
    CHECK(call.wait().code == 130);
    for (const char* name : {"b.exr", "c.exr"}) {
        Words words = {"render", place.scene, "-o", place / name, "-q", "--size", "200x200", "--spp", "150"};
        if (name[0] == 'c') words.insert(words.end(), {"--write-every", "0.05"});
        REQUIRE(run(words).code == 0);
    }
    CHECK(incomplete(place / "c.exr") == 0);
    CHECK(read_back(place / "b.exr").values == read_back(place / "c.exr").values);
}

TEST_CASE("an interrupt is heeded within a second in every phase") {
    const SceneFolder place;
    const std::string endless = place / "endless.lua", out = place / "a";
    write_file(endless, "local s = 0\nfor i = 1, 1e15 do s = s + i % 7 end\nreturn {}");
    write_file(place / "plate.lua", plate);
    write_file(place / "blocks.lua", blocks);
    const std::string holes = place / "plate.lua", many = place / "blocks.lua";
    const std::pair<Words, double> calls[] = {
        {{"info", endless}, 0},  // interrupted as soon as the program handles the signal
        {{"render", endless, "-o", out + ".png"}, 0.2},
        {{"info", many}, 0.7},
        {{"render", many, "-o", out + ".png"}, 1},
        {{"compare", many}, 1},
        {{"export-pov", many, "-o", out + ".pov"}, 1},
        {{"mesh", holes, "-o", out + ".stl"}, 1},
        {{"mesh", holes, "-o", out + ".stl", "--method", "octree"}, 1},
        {{"mesh", holes, "-o", out + ".stl", "--method", "marching-cubes", "--grid", "0.1"}, 0.5},
        {{"render", holes, "--via", "triage", "-o", out + ".png"}, 1},
        {{"figures", "-o", place / "figures"}, 0.5},
    };
    int signal = SIGINT;
    for (const auto& [words, after] : calls) {
        Call call(words);
        REQUIRE(call.handles(signal));
        pause_for(after);
        const auto start = std::chrono::steady_clock::now();
        call.send(signal);
        const Outcome o = call.wait();
        CAPTURE(words, signal, o.err);
        CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
        CHECK(o.code == 130);
        CHECK(o.err.find("deburr: interrupted") != std::string::npos);
        signal = signal == SIGINT ? SIGTERM : SIGINT;
    }
    std::filesystem::remove_all(place / "figures");
    CHECK(place.names() == Words{"blocks.lua", "cube.lua", "endless.lua", "plate.lua"});
}
