// --integrator, --noise, --time and --view, and environment pictures from files.
#include <cmath>

#include "catch.hpp"
#include "raytracer/cli/scene_folder.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

namespace {

// Renders scenes and reads their pictures back.
struct PictureFolder : SceneFolder {
    Outcome call(const std::vector<std::string>& more, const std::string& file = "") const {
        std::vector<std::string> words = {"render", file.empty() ? scene : file, "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
    PictureFile render(const std::string& name, std::vector<std::string> more, const std::string& file = "") const {
        more.insert(more.end(), {"--float", "-o", *this / name});
        const Outcome o = call(more, file);
        CAPTURE(o.err);
        REQUIRE(o.code == 0);
        return read_back(*this / name);
    }
};

bool same_values(const PictureFile& a, const PictureFile& b) { return a.values == b.values; }

}  // namespace

TEST_CASE("one sample is a preview unless paths are asked for, and more are paths unless a preview is") {
    const PictureFolder place;
    const PictureFile one = place.render("a.exr", {"--spp", "1"});
    CHECK(same_values(one, place.render("b.exr", {"--spp", "1", "--integrator", "preview"})));
    CHECK_FALSE(same_values(one, place.render("c.exr", {"--spp", "1", "--integrator", "path"})));
    const PictureFile four = place.render("d.exr", {"--spp", "4"});
    CHECK(same_values(four, place.render("e.exr", {"--spp", "4", "--integrator", "path"})));
    CHECK_FALSE(same_values(four, place.render("f.exr", {"--spp", "4", "--integrator", "preview"})));
}

TEST_CASE("a picture with a bound of noise is the same for any threads, and a crop of it is a part of it") {
    const PictureFolder place;
    const PictureFile whole = place.render("a.exr", {"--noise", "0.05", "--spp", "64", "--threads", "1"});
    CHECK(same_values(whole, place.render("b.exr", {"--noise", "0.05", "--spp", "64", "--threads", "3"})));
    const PictureFile crop = place.render("c.exr", {"--noise", "0.05", "--spp", "64", "--crop", "21x13+17+9"});
    int compared = 0;
    for (int y = 0; y < 13; ++y)
        for (int x = 0; x < 21; ++x)
            for (int c = 0; c < 3; ++c) compared += crop.at(x + 17, y + 9, c) == whole.at(x + 17, y + 9, c);
    CHECK(compared == 21 * 13 * 3);
    CHECK_FALSE(same_values(whole, place.render("d.exr", {"--noise", "0.005", "--spp", "256"})));
}

TEST_CASE("--time takes as many samples as it has time for") {
    const PictureFolder place;
    const PictureFile p = place.render("a.exr", {"--time", "0.5"});
    const int samples = p.attribute<int>("samplesPerPixel");
    CHECK(samples > 2);
    CHECK(same_values(p, place.render("b.exr", {"--spp", std::to_string(samples)})));
}

TEST_CASE("a tone curve is for the screen and leaves an EXR as it is") {
    const PictureFolder place;
    const PictureFile plain = place.render("a.exr", {"--spp", "2", "-o", place / "a.png"});
    CHECK(same_values(plain, place.render("b.exr", {"--spp", "2", "--view", "agx", "-o", place / "b.png"})));
    CHECK_FALSE(same_values(read_back(place / "a.png"), read_back(place / "b.png")));
}

TEST_CASE("a picture from a file lights a scene, behind another background, too") {
    const PictureFolder place;
    // An environment of uniform light of radiance 0.5.
    write_file(
        place / "room.lua",
        "return { image = { width = 16, height = 8 }, background = 0.5, lights = {}, camera = { eye = {0, 0, 9} },"
        " solids = { box({0, 0, 90}, {1, 1, 91}) } }");
    place.render("room.exr", {"--spp", "1"}, place / "room.lua");
    const std::string solids =
        "lights = {}, camera = { eye = {0, 0, 9}, fov = 30 }, image = { width = 20, height = 20 },"
        " solids = { ellipsoid{}:material(matte{ color = 0.6 }) } }";
    write_file(place / "ball.lua", "return { background = environment{ file = 'room.exr', scale = 2 }, " + solids);
    write_file(place / "other.lua",
               "return { background = {1, 0, 0}, environment = environment{ file = 'room.exr', scale = 2 }, " + solids);
    const PictureFile ball = place.render("ball.exr", {"--spp", "16"}, place / "ball.lua");
    const PictureFile other = place.render("other.exr", {"--spp", "16"}, place / "other.lua");
    for (int c = 0; c < 3; ++c) {
        CHECK(ball.at(10, 10, c) == Approx(0.6).margin(0.02));
        CHECK(ball.at(0, 0, c) == Approx(1).margin(1e-6));
        CHECK(other.at(10, 10, c) == Approx(0.6).margin(0.02));
        CHECK(other.at(0, 0, c) == (c == 0 ? 1 : 0));
    }
    write_file(place / "none.lua", "return { background = environment{ file = 'none.exr' },\n" + solids);
    const Outcome o = place.call({"-o", place / "x.exr"}, place / "none.lua");
    CHECK(o.code == 2);
    CHECK(o.err.find("none.lua:1: environment.file: ") != std::string::npos);
}

TEST_CASE("wrong values of the options of light end with exit code 2 and one line") {
    const PictureFolder place;
    const auto said = [&](const std::vector<std::string>& words, const std::string& what) {
        std::vector<std::string> all = words;
        all.insert(all.end(), {"-o", place / "x.png"});
        const Outcome o = place.call(all);
        CHECK(o.code == 2);
        CHECK(o.err.find(what) != std::string::npos);
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    };
    said({"--integrator", "paths"}, "--integrator: expected path or preview, got 'paths'");
    said({"--noise", "0"}, "--noise: expected");
    said({"--time", "-1"}, "--time: expected");
    said({"--view", "film"}, "--view: expected standard or agx, got 'film'");
    said({"--noise", "0.1", "--integrator", "preview"}, "--noise: expected --integrator path, got 'preview'");
    said({"--time", "1", "--spp", "4"}, "--time: expected no --spp beside it, got one");
}
