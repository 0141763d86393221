// LivePicture: previews are cut short when the camera moves.
#include "raytracer/view/live_picture.hpp"

#include "catch.hpp"
#include "raytracer/scene/scene_reader.hpp"

using namespace deburr;

// The picture is so large that its sharp preview takes much longer than anything else, on any machine.
TEST_CASE("a camera that moves cuts the sharp preview and the samples of the last one short") {
    const std::string text =
        "return { image = { width = 1200, height = 900 }, camera = { eye = {3, 2, 4}, target = {0, 0, 0}, fov = 40 }, "
        "solids = { torus{ radius = 1, tube = 0.4 } | rounded(0.1, torus{ radius = 0.7, tube = 0.3 }) } }";
    LivePicture live([&](const auto&) { return read_scene_text(text, "s.lua"); }, {});
    const std::chrono::seconds ever(120);
    int seen = 0;
    const auto next = [&] {
        const auto frame = live.wait_for_frame(seen, ever);
        REQUIRE(frame);
        REQUIRE(frame->error == "");
        seen = frame->number;
        return frame;
    };
    using Clock = std::chrono::steady_clock;
    while (next()->width < 1200) {
    }
    Camera camera = live.scene()->camera;
    const auto move = [&] {
        camera.eye.x += 0.1;
        live.set_camera(camera);
    };
    move();
    while (next()->width == 1200) {
    }
    const Clock::time_point coarse = Clock::now();
    while (next()->width < 1200) {
    }
    const auto sharp = Clock::now() - coarse;  // includes the pause before it
    // If the machine is faster this time and the sharp preview ends before the camera moves, the test tries again.
    bool is_cut = false;
    for (int i = 0; i < 30 && !is_cut; ++i) {
        move();
        while (next()->width == 1200) {
        }
        std::this_thread::sleep_for(sharp / 2);  // the sharp preview is under way
        move();
        is_cut = next()->width < 1200;
    }
    CHECK(is_cut);
}
