#include "raytracer/image/camera_matrix.hpp"

#include <glm/gtc/constants.hpp>

namespace deburr {
namespace {

// A coordinate as an affine function of the point x: axis·x + shift.
struct Coordinate {
    Vec3 axis{0.0};
    double shift = 0;
};

Coordinate operator+(Coordinate a, Coordinate b) { return {a.axis + b.axis, a.shift + b.shift}; }
Coordinate operator*(double s, Coordinate a) { return {s * a.axis, s * a.shift}; }

struct Frame {
    Coordinate right, up, forward;

    explicit Frame(const Camera& camera) {
        const Vec3 f = glm::normalize(camera.target - camera.eye);
        const Vec3 r = glm::normalize(glm::cross(f, camera.up));  // the world is right-handed
        const Vec3 u = glm::cross(r, f);
        right = {r, -glm::dot(r, camera.eye)};
        up = {u, -glm::dot(u, camera.eye)};
        forward = {f, -glm::dot(f, camera.eye)};
    }
};

Matrix44 matrix(const std::array<Coordinate, 4>& columns) {
    Matrix44 m{};
    for (std::size_t j = 0; j < 4; ++j) {
        for (int i = 0; i < 3; ++i) m[i][j] = float(columns[j].axis[i]);
        m[3][j] = float(columns[j].shift);
    }
    return m;
}

}  // namespace

Matrix44 world_to_camera(const Camera& camera) {
    const Frame frame(camera);
    return matrix({frame.right, frame.up, frame.forward, {Vec3(0.0), 1}});
}

Matrix44 world_to_ndc(const Camera& camera, int width, int height) {
    const Frame frame(camera);
    const double h = std::tan(camera.fov * glm::pi<double>() / 360);
    const double w = h * width / height;
    const double x = 0.5 - camera.shift.x, y = 0.5 + camera.shift.y;  // position of the axis in the picture
    if (camera.orthographic) {
        const double distance = glm::length(camera.target - camera.eye);
        return matrix({Coordinate{Vec3(0.0), x} + (0.5 / (w * distance)) * frame.right,
                       Coordinate{Vec3(0.0), y} + (-0.5 / (h * distance)) * frame.up,
                       frame.forward,
                       {Vec3(0.0), 1}});
    }
    // x/(z w) runs from −1 at the left to 1 at the right, y/(z h) from −1 at the bottom to 1 at the top.
    return matrix({x * frame.forward + (0.5 / w) * frame.right,
                   y * frame.forward + (-0.5 / h) * frame.up,
                   {Vec3(0.0), 1},
                   frame.forward});
}

}  // namespace deburr
