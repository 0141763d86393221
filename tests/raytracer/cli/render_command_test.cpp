// The files and statistics that `deburr render` writes.
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/cli/scene_folder.hpp"
#include "raytracer/picture_file.hpp"

using namespace deburr::test;

TEST_CASE("render writes all outputs, and quiet says nothing") {
    const SceneFolder place;
    const Outcome o = run(place.render({"-o", place / "b.png", "-D", "r=0.2"}));
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(o.err.empty());
    CHECK(o.out.empty());
    CHECK(place.names() == Words{"a.exr", "b.png", "cube.lua"});
    const PictureFile picture = read_back(place / "a.exr");
    CHECK(picture.width == 60);
    CHECK(picture.height == 40);
    CHECK(picture.attribute<std::string>("deburr.scene") == place.scene);
    CHECK(picture.attribute<std::string>("deburr.parameter.r") == "0.2");
    CHECK(picture.attribute<float>("renderTimeSeconds", -1) >= 0);
    CHECK(read_back(place / "b.png").channels.size() == 3);
}

TEST_CASE("elsewhere than on a terminal progress is lines") {
    const SceneFolder place;
    const Outcome o = run({"render", place.scene, "-o", place / "a.exr"});
    CHECK(o.code == 0);
    CHECK(o.err.find('\r') == std::string::npos);
    CHECK(o.err.find("100 %") != std::string::npos);
}

TEST_CASE("files are the same to the byte with SOURCE_DATE_EPOCH, whatever the threads", "[threads]") {
    const SceneFolder place;
    const Words epoch = {"SOURCE_DATE_EPOCH=1700000000"};
    for (const std::string threads : {"1", "2", "2"}) {
        const Outcome o = run(
            place.render({"-o", place / "a.png", "--spp", "4", "--aov", "P,N,Z,albedo,id,cost", "--threads", threads}),
            epoch);
        REQUIRE(o.code == 0);
        static std::string exr, png;
        if (exr.empty()) {
            exr = read_file(place / "a.exr");
            png = read_file(place / "a.png");
        }
        CHECK(read_file(place / "a.exr") == exr);
        CHECK(read_file(place / "a.png") == png);
    }
    const PictureFile picture = read_back(place / "a.exr");
    CHECK(picture.attribute<std::string>("DateTime") == "2023:11:14 22:13:20");
    CHECK(picture.attributes.count("renderTimeSeconds") == 0);
}

TEST_CASE("a crop has the bytes of the whole picture") {
    const SceneFolder place;
    const Words layers = {"--spp", "3", "--aov", "P,N,Z,albedo,id,cost"};
    REQUIRE(run(place.render(layers)).code == 0);
    const PictureFile whole = read_back(place / "a.exr");
    for (const std::string crop : {"23x17+20+11", "1x1+59+39", "60x1+0+20"}) {
        Words more = layers;
        more.insert(more.end(), {"--crop", crop});
        REQUIRE(run(place.render(more, "part.exr")).code == 0);
        const PictureFile part = read_back(place / "part.exr");
        CHECK(part.full_width == 60);
        CHECK(part.full_height == 40);
        REQUIRE(part.types == whole.types);
        for (int y = part.y; y < part.y + part.height; ++y)
            for (int x = part.x; x < part.x + part.width; ++x)
                REQUIRE(std::memcmp(part.pixel(x, y), whole.pixel(x, y), whole.pixel_bytes()) == 0);
    }
}

TEST_CASE("crops of a poster that is too large as a whole are rendered, and pasted are the whole") {
    const SceneFolder place;
    const Outcome large = run(place.render({"--size", "30000x30000", "--crop", "40x30+14000+16000"}));
    CAPTURE(large.err);
    REQUIRE(large.code == 0);
    const PictureFile poster = read_back(place / "a.exr");
    CHECK(poster.full_width == 30000);
    CHECK(poster.x == 14000);
    CHECK(run(place.render({"--size", "30000x30000", "--crop", "20000x20000+0+0"})).code == 2);
    for (const Words& how : {Words{}, Words{"--via", "triage", "--edges"}, Words{"--alpha", "--bits", "16"}}) {
        Words more = {"--size", "90x60", "--spp", "2"};
        more.insert(more.end(), how.begin(), how.end());
        REQUIRE(run(place.render(more, "whole.png")).code == 0);
        const PictureFile whole = read_back(place / "whole.png");
        int pixels = 0;
        for (int y = 0; y < 60; y += 30)
            for (int x = 0; x < 90; x += 40) {
                Words cut = more;
                const int w = std::min(40, 90 - x);
                cut.insert(cut.end(),
                           {"--crop", std::to_string(w) + "x30+" + std::to_string(x) + "+" + std::to_string(y)});
                REQUIRE(run(place.render(cut, "part.png")).code == 0);
                const PictureFile part = read_back(place / "part.png");
                for (int row = 0; row < 30; ++row)
                    REQUIRE(std::memcmp(part.pixel(0, row), whole.pixel(x, y + row),
                                        std::size_t(w) * whole.pixel_bytes()) == 0);
                pixels += 30 * w;
            }
        CHECK(pixels == 90 * 60);
    }
}

TEST_CASE("a picture by --accel bvh, under its older name and by embree is the same to the byte, and says by which") {
    const SceneFolder place;
    for (const std::string scene : {"csg_examples", "variable_rounding", "staplers"}) {
        CAPTURE(scene);
        std::vector<unsigned char> bytes;
        for (const std::string accel : {"bvh", "bsp", "embree"}) {
            const std::string recorded = accel == "embree" ? accel : "bsp";  // as pictures have always recorded it
            const Outcome o = run(
                {"render", DEBURR_SOURCE_DIR "/scenes/" + scene + ".lua", "-q", "-o", place / "a.exr", "--accel", accel,
                 "--size", "120x80", "--float", "--aov", "P,N,Z,id", "--stats", "--stats-json", place / "s.json"},
                {"SOURCE_DATE_EPOCH=0"});
            REQUIRE(o.code == 0);
            const PictureFile picture = read_back(place / "a.exr");
            CHECK(picture.attribute<std::string>("deburr.accel") == recorded);
            CHECK(nlohmann::json::parse(read_file(place / "s.json"))["accel"] == recorded);
            CHECK(o.out.find("accel") != std::string::npos);
            if (bytes.empty()) bytes = picture.bytes;
            CHECK(picture.bytes == bytes);
        }
    }
    REQUIRE(run(place.render({"--via", "triage"})).code == 0);
    CHECK(read_back(place / "a.exr").attributes.count("deburr.accel") == 0);
}

TEST_CASE("another seed gives another picture only where there are random samples") {
    const SceneFolder place;
    const Words epoch = {"SOURCE_DATE_EPOCH=0"};
    std::vector<std::vector<unsigned char>> bytes;
    for (const Words& more : {Words{"--spp", "1", "--seed", "1"}, Words{"--spp", "1", "--seed", "2"},
                              Words{"--spp", "4", "--seed", "1"}, Words{"--spp", "4", "--seed", "2"}}) {
        REQUIRE(run(place.render(more), epoch).code == 0);
        bytes.push_back(read_back(place / "a.exr").bytes);
    }
    CHECK(bytes[0] == bytes[1]);
    CHECK(bytes[2] != bytes[3]);
}

TEST_CASE("statistics as a table and as JSON") {
    const SceneFolder place;
    const Outcome o = run(place.render({"--stats", "--stats-json", place / "s.json", "--threads", "1", "--seed", "7"}));
    REQUIRE(o.code == 0);
    for (const char* word : {"rays", "shadow rays", "splits", "density evaluations", "BSP cells", "60x40"})
        CHECK(o.out.find(word) != std::string::npos);
    const auto j = nlohmann::json::parse(read_file(place / "s.json"));
    CHECK(j["version"] == DEBURR_VERSION);
    CHECK(j["complete"] == true);
    CHECK(j["width"] == 60);
    CHECK(j["threads"] == 1);
    CHECK(j["seed"] == 7);
    CHECK(j["pixels"] == 2400);
    CHECK(j["rays"] >= 2400);
    CHECK(j["bsp"]["cells"] > 0);
    for (const char* phase : {"read", "build", "trace", "write"}) {
        CHECK(j["seconds"][phase]["wall"] >= 0);
        CHECK(j["seconds"][phase]["cpu"] >= 0);
    }
}
