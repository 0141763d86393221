// frame{}: the camera that shows all of a scene.
#include "raytracer/scene/frame_camera.hpp"

#include <fmt/format.h>

#include <glm/ext/matrix_transform.hpp>

#include "catch.hpp"
#include "raytracer/render/camera.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/scene/scene_text.hpp"
#include "raytracer/scene/solid_survey.hpp"
#include "raytracer/util/cpu_time.hpp"

using namespace deburr;

namespace {

constexpr int view_width = 600, view_height = 380;

Scene framed(const std::string& solids, const std::string& camera = "") {
    Scene scene = scene_of("return { " + camera + " solids = { " + solids + " } }");
    REQUIRE(frame_camera(scene, double(view_width) / view_height));
    return scene;
}

// The box of the points' projections: pixels in x and y, depths in z.
Box projected_box(const Camera& camera, const std::vector<Vec3>& points, int w = view_width, int h = view_height) {
    const ProjectiveCamera view(camera, w, h);
    Box box;
    for (const Vec3 p : points) {
        const Vec3 at = view.project(p);
        box = hull(box, {at, at});
    }
    return box;
}

std::vector<Vec3> corners(Vec3 lo, Vec3 hi) {
    std::vector<Vec3> all;
    for (int i = 0; i < 8; ++i) all.push_back({(i & 1 ? hi : lo).x, (i & 2 ? hi : lo).y, (i & 4 ? hi : lo).z});
    return all;
}

}  // namespace

TEST_CASE("a framed box fills the picture in one direction with even margins, whatever its size and place") {
    for (const char* box : {"cube()", "box({1000, -3, 5}, {1400, 100, 30})", "cube():scale(1e-3):translate(3, 4, 5)",
                            "box({0, 0, 0}, {1, 50, 1})"}) {
        CAPTURE(box);
        const Scene scene = framed(box);
        std::vector<Vec3> points = corners({0, 0, 0}, {1, 1, 1});
        if (std::string(box).find("1000") != std::string::npos) points = corners({1000, -3, 5}, {1400, 100, 30});
        if (std::string(box).find("1e-3") != std::string::npos) points = corners({3, 4, 5}, Vec3(3, 4, 5) + Vec3(1e-3));
        if (std::string(box).find("50") != std::string::npos) points = corners({0, 0, 0}, {1, 50, 1});
        const Box at = projected_box(scene.camera, points);
        CHECK(at.lo.z > 0);
        const double across = (at.hi.x - at.lo.x) / view_width, along = (at.hi.y - at.lo.y) / view_height;
        CHECK(std::max(across, along) == Approx(0.86).epsilon(1e-3));
        const double margin = 0.5 * (1 - 0.86) - 0.001;
        CHECK(at.lo.x >= margin * view_width);
        CHECK(at.hi.x <= view_width - margin * view_width);
        CHECK(at.lo.y >= margin * view_height);
        CHECK(at.hi.y <= view_height - margin * view_height);
        if (across > along)
            CHECK(at.lo.x + at.hi.x == Approx(view_width));
        else
            CHECK(at.lo.y + at.hi.y == Approx(view_height));
        CHECK(scene.camera.fov == 30);
    }
}

TEST_CASE("floors and empty solids do not count for a framed camera") {
    const Scene alone = framed("cube()");
    const Scene beside = framed("cube(), halfspace({0, 1, 0}, 0), cube() & box({3, 0, 0}, {4, 9, 9})");
    CHECK(alone.camera.eye == beside.camera.eye);
    CHECK(alone.camera.target == beside.camera.target);

    Scene floor = scene_of("return { solids = { halfspace({0, 1, 0}, 0) } }");
    CHECK_FALSE(frame_camera(floor, 1.5));
    CHECK(floor.camera.eye == Camera().eye);
}

TEST_CASE("a turned box and a ball are framed by themselves, not by the boxes around them") {
    // The axis-parallel box around a cube that is rotated by 45° is wider than the cube's outline by √2.
    const Scene turned = framed("cube():rotate(45, {0, 1, 0})", "camera = frame{ from = {0, 0, 1}, fov = 1 },");
    const Box at = projected_box(turned.camera, {{0, 0, 0}, {0, 1, 0}, {std::sqrt(2.0), 1, 0}, {std::sqrt(2.0), 0, 0}});
    CHECK((at.hi.y - at.lo.y) / view_height == Approx(0.86).epsilon(0.02));

    const double r = 2;
    const Scene ball = framed("ellipsoid{ center = {1, 2, 3}, radius = 2 }", "camera = frame{ from = {1, 1, 1} },");
    const double distance = glm::distance(ball.camera.eye, Vec3(1, 2, 3));
    // Tangent of the angle between the axis and the ball's outline.
    const double tangent = r / std::sqrt(distance * distance - r * r);
    CHECK(tangent / std::tan(15 * pi / 180) == Approx(0.86).epsilon(1e-3));
}

TEST_CASE("round solids are framed by themselves, not by the boxes around them") {
    // A sphere on a rod, far from the corners of their bounding box.
    std::vector<Vec3> points;
    constexpr int n = 40;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const double a = pi * i / n, b = pi * j / n;
            points.push_back(Vec3(5) + Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
        }
    points.push_back(Vec3(0));
    for (const char* camera : {"", "camera = frame{ from = {1, 0, 0} },", "camera = frame{ from = {-1, 2, -3} },"})
        for (const char* solid : {"rounded(0.01, sphere{ center = {5, 5, 5} } | cylinder{ to = {5, 5, 5}, from = {0, "
                                  "0, 0}, radius = 0.05 })",
                                  "ellipsoid{ center = {5, 5, 5}, radius = 1 } | "
                                  "sharp(cylinder{ to = {5, 5, 5}, from = {0, 0, 0}, radius = 0.05 })"}) {
            CAPTURE(camera, solid);
            const Box at = projected_box(framed(solid, camera).camera, points);
            const double across = (at.hi.x - at.lo.x) / view_width, along = (at.hi.y - at.lo.y) / view_height;
            CHECK(std::max(across, along) == Approx(0.86).margin(0.03));
            // The direction that limits the distance has even margins.
            CHECK((across > along ? std::abs(at.lo.x + at.hi.x - view_width) / view_width
                                  : std::abs(at.lo.y + at.hi.y - view_height) / view_height) < 0.03);
        }
}

TEST_CASE("a framed camera looks from where it is told, and needs no up that fits") {
    for (const Vec3 from : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(-3, 1, 2), Vec3(0, 1e-9, 1)}) {
        CAPTURE(from.x, from.y, from.z);
        const Scene scene =
            framed("box({0, 0, 0}, {3, 1, 2})",
                   fmt::format("camera = frame{{ from = {{{}, {}, {}}}, fov = 50 }},", from.x, from.y, from.z));
        const Camera& c = scene.camera;
        CHECK(c.fov == 50);
        CHECK(glm::distance(glm::normalize(c.eye - c.target), glm::normalize(from)) < 1e-9);
        const Box at = projected_box(c, corners({0, 0, 0}, {3, 1, 2}));
        CHECK(at.lo.x > 0);
        CHECK(at.lo.y > 0);
        CHECK(at.hi.x < view_width);
        CHECK(at.hi.y < view_height);
        // From above, the side away from the front view's viewer is at the top.
        if (from.y == 1) CHECK(projected_box(c, {{0, 0, 0}}).lo.y < projected_box(c, {{0, 0, 2}}).lo.y);
    }
}

TEST_CASE("a tall picture is framed by its width") {
    Scene scene = scene_of("return { solids = { cube() } }");
    REQUIRE(frame_camera(scene, 0.25));
    const Box at = projected_box(scene.camera, corners({0, 0, 0}, {1, 1, 1}), 100, 400);
    CHECK((at.hi.x - at.lo.x) / 100 == Approx(0.86).epsilon(1e-3));
    CHECK(at.lo.x + at.hi.x == Approx(100));
}

TEST_CASE("the default light stays over the viewer's left shoulder when the camera is framed") {
    Scene scene = scene_of("return { camera = frame{ from = {0, 0, 1} }, solids = { cube() } }");
    REQUIRE(frame_camera(scene, 1.5));
    REQUIRE(scene.lights.size() == 1);
    const Vec3 travels = scene.lights[0].direction;
    CHECK(travels.x > 0);
    CHECK(travels.y < 0);
    CHECK(travels.z < 0);
}

TEST_CASE("a camera that frames many solids looks at few of them, and does not depend on their order", "[slow]") {
    // A rotated grid: its blocks' bounding boxes are much larger than the blocks, so the outermost blocks decide.
    const auto grid = [](int n, const char* order) {
        return scene_of(
            fmt::format("local t = {{}} local n = {} local block = rounded(0.1, cube()):rotate(30, {{1, 2, 3}})\n"
                        "for i = 0, n * n - 1 do t[i + 1] = block:translate(3 * (i % n), 0, 3 * (i // n)) end\n"
                        "local s = {{}} for i = 1, #t do s[i] = t[{}] end\n"
                        "return {{ solids = s }}",
                        n, order));
    };
    const double aspect = double(view_width) / view_height;
    const auto camera = [&](const Scene& scene) { return *framed_camera(scene.solids, {}, Vec3(0, 1, 0), aspect); };
    const Camera one = camera(grid(12, "i"));
    for (const char* order : {"#t + 1 - i", "1 + (i * 55) % #t"}) {
        const Camera other = camera(grid(12, order));
        CHECK(one.eye == other.eye);
        CHECK(one.target == other.target);
    }
    // The corners of all blocks of the grid.
    const Scene scene = grid(12, "i");
    const Mat3 turn(glm::rotate(glm::dmat4(1), glm::radians(30.0), glm::normalize(Vec3(1, 2, 3))));
    std::vector<Vec3> points;
    for (const Vec3 p : corners({0, 0, 0}, {1, 1, 1}))
        for (int i = 0; i < 144; ++i) points.push_back(turn * p + Vec3(3 * (i % 12), 0, 3 * (i / 12)));
    const Box at = projected_box(one, points);
    CHECK(std::max((at.hi.x - at.lo.x) / view_width, (at.hi.y - at.lo.y) / view_height) == Approx(0.86).epsilon(0.01));

    const Scene many = grid(100, "i");
    const Ratio ratio = ratio_of_times([&] { return cpu_seconds_of([&] { camera(many); }); },
                                       [&] {
                                           return cpu_seconds_of([&] {
                                               SolidSurvey survey;
                                               for (const Solid& solid : many.solids) survey.at(solid);
                                           });
                                       },
                                       3);
    CHECK(ratio.value() < 2);
}
