// The camera matrices worldToCamera and worldToNDC in an EXR's header.
#include "raytracer/image/camera_matrix.hpp"

#include "catch.hpp"
#include "raytracer/render/integrator.hpp"

using namespace deburr;

namespace {

std::array<double, 4> times(Vec3 x, const Matrix44& m) {
    std::array<double, 4> y{};
    for (std::size_t j = 0; j < 4; ++j) y[j] = x.x * m[0][j] + x.y * m[1][j] + x.z * m[2][j] + m[3][j];
    return y;
}

Camera camera() {
    Camera c;
    c.eye = {3, 2.5, 4};
    c.target = {0.5, 0.25, -0.5};
    c.up = {0.1, 1, 0};
    c.fov = 37;
    return c;
}

// The file holds seven digits, and sums of three terms lose a few of them.
constexpr double float_error = 1e-5;

}  // namespace

TEST_CASE("worldToNDC sends what a pixel sees to the pixel's place in the window") {
    const int width = 640, height = 360;
    for (int kind = 0; kind < 4; ++kind) {
        Camera given = camera();
        given.orthographic = kind % 2 == 1;
        if (kind >= 2) given.shift = {0.2, -0.4, 0};
        const ProjectiveCamera view(given, width, height);
        const Matrix44 ndc = world_to_ndc(given, width, height);
        for (const double px : {0.0, 100.5, 320.0, 640.0})
            for (const double py : {0.0, 17.5, 180.0, 360.0})
                for (const double distance : {0.5, 3.0, 50.0}) {
                    const Ray ray = view.ray(px, py);
                    const auto p = times(ray.origin + distance * ray.direction, ndc);
                    CAPTURE(kind, px, py, distance);
                    CHECK(std::abs(p[0] / p[3] - px / width) < float_error);
                    CHECK(std::abs(p[1] / p[3] - py / height) < float_error);
                }
    }
}

TEST_CASE("worldToCamera looks along +z, with x right and y up") {
    const ProjectiveCamera view(camera(), 640, 360);
    const Matrix44 m = world_to_camera(camera());
    const auto at = [&](double px, double py) {
        const Ray ray = view.ray(px, py);
        return times(ray.origin + 2.0 * ray.direction, m);
    };
    const auto middle = at(320, 180);
    CHECK(std::abs(middle[0]) < float_error);
    CHECK(std::abs(middle[1]) < float_error);
    CHECK(std::abs(middle[2] - 2) < float_error);
    CHECK(middle[3] == 1);
    CHECK(at(639, 180)[0] > 0.1);
    CHECK(at(320, 1)[1] > 0.1);
}
