// The number of samples that a picture gets without --spp, from its noise and its time.
#include "raytracer/render/sample_count.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catch.hpp"
#include "raytracer/program.hpp"
#include "raytracer/scene/frame_camera.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

struct SampledScene {
    Scene scene;
    ImplicitTracer tracer;

    explicit SampledScene(const std::string& text) : scene(framed(text)), tracer(scene.solids) {}
    static Scene framed(const std::string& text) {
        Scene scene = read_scene_text(text, "s.lua");
        frame_camera(scene, 1.5);
        return scene;
    }
    int count(int width = 120, int height = 80, double exposure = 0) const {
        return sample_count(scene, tracer, {.width = width, .height = height}, exposure).samples;
    }
};

}  // namespace

TEST_CASE("a picture gets as many samples as its noise asks for") {
    const std::string solids = "solids = { rounded(0.1, cube()), halfspace({0, 1, 0}, 0) }";
    const SampledScene plain(
        "return { lights = {}, ambient = 0.5, camera = { eye = {0, 5, 0}, target = {0, 0, 0}, up = {1, 0, 0} }, "
        "solids = { halfspace({0, 1, 0}, 0) } }");
    const SampledScene noisy(
        "return { lights = { area_light{ position = {3, 4, 3}, u = {2, 0, 0}, v = {0, 2, 0}, power = 400 }, "
        "area_light{ position = {3, 4, 3}, u = {-4, 0, 0}, v = {0, 4, -4}, power = 900 } }, " +
        solids + " }");
    CHECK(plain.count() == min_sample_count);
    CHECK(noisy.count() > 2 * min_sample_count);
    CHECK(noisy.count() <= max_sample_count);
    CHECK(noisy.count() == noisy.count());
    // A picture that is all black or all white has no visible noise.
    CHECK(noisy.count(120, 80, -20) == min_sample_count);
    // A picture of many pixels needs fewer samples per pixel.
    CHECK(noisy.count(20'000, 10'000) < min_sample_count);
    CHECK(noisy.count(1, 1) >= min_sample_count);
}

TEST_CASE("a picture whose samples would take long gets fewer, whatever its noise") {
    // Interlocking tori under large lamps, which are close and bright.
    std::string rings, lamps;
    for (int i = 0; i < 12; ++i)
        rings += (i ? " | " : "") + fmt::format("torus{{ radius = 1, tube = 0.2 }}:rotate({}, {{1, 0, 1}})", 15 * i);
    for (int i = 0; i < 3; ++i)
        lamps += fmt::format("area_light{{ position = {{{}, 3, 1}}, u = {{6, 0, 0}}, v = {{0, 0, 6}}, power = 300 }}, ",
                             3 * i - 3);
    const SampledScene slow("return { lights = { " + lamps + " }, solids = { rounded(0.05, " + rings + ") } }");
    const auto count = [&](int width, int height) {
        return sample_count(slow.scene, slow.tracer, {.width = width, .height = height}, -3);
    };
    const SampleCount small = count(120, 80), large = count(7200, 6400), huge = count(24'000, 16'000);
    CAPTURE(small.samples, small.wanted, large.samples, large.wanted, huge.samples);
    CHECK(small.samples == small.wanted);
    CHECK(large.samples < large.wanted);
    CHECK(large.samples >= min_costly_sample_count);
    CHECK(huge.samples == min_costly_sample_count);
    CHECK(huge.wanted == min_sample_count);
    // Twice as many pixels take twice as long, so that each may have half as many samples.
    const int larger = count(10'182, 9051).samples;
    CAPTURE(larger);
    CHECK(std::abs(2 * larger - large.samples) <= 2);
}

TEST_CASE("render without --spp is render with the number that it finds, and a crop has the same") {
    const Folder folder;
    const std::string scene = folder / "s.lua", a = folder / "a.exr", b = folder / "b.exr", c = folder / "c.exr";
    write_file(scene,
               "return { image = { width = 48, height = 32 }, "
               "solids = { rounded(0.1, cube()), halfspace({0, 1, 0}, 0) } }");
    const std::vector<std::string> epoch = {"SOURCE_DATE_EPOCH=0"};
    const Outcome found = run({"render", scene, "-v", "-o", a}, epoch);
    REQUIRE(found.code == 0);
    const std::size_t at = found.err.find(" samples per pixel");
    REQUIRE(at != std::string::npos);
    const std::string number =
        found.err.substr(found.err.rfind(' ', at - 1) + 1, at - found.err.rfind(' ', at - 1) - 1);
    CHECK(std::stoi(number) >= min_sample_count);
    REQUIRE(run({"render", scene, "--spp", number, "-o", b}, epoch).code == 0);
    CHECK(read_file(a) == read_file(b));
    const Outcome crop = run({"render", scene, "-v", "--crop", "8x8+0+0", "-o", c}, epoch);
    CHECK(crop.err.find(" " + number + " samples per pixel") != std::string::npos);
}

TEST_CASE("--draft is one sample, whatever the scene says") {
    const Folder folder;
    const std::string scene = folder / "s.lua", a = folder / "a.png", b = folder / "b.png";
    write_file(scene, "return { image = { width = 48, height = 32, spp = 7 }, solids = { cube() } }");
    const std::vector<std::string> epoch = {"SOURCE_DATE_EPOCH=0"};
    REQUIRE(run({"render", scene, "--draft", "-o", a}, epoch).code == 0);
    REQUIRE(run({"render", scene, "--spp", "1", "-o", b}, epoch).code == 0);
    CHECK(read_file(a) == read_file(b));
    CHECK(run({"render", scene, "-v", "-o", a}).err.find(" 7 samples per pixel") != std::string::npos);
    CHECK(run({"render", scene, "--draft", "--spp", "4", "-o", a}).code == 2);
}
