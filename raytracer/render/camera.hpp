// The pinhole camera: from points of the picture to rays, and from points of the world to the picture.
#pragma once
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

class PinholeCamera {
public:
    PinholeCamera(const Camera& camera, int width, int height);
    /// Ray through a point of the picture, in pixels: (x + ½, y + ½) is the centre of pixel (x, y).
    Ray ray(double x, double y) const;
    /// Where a point is seen: x and y as ray() takes them, and z its distance along the axis; x and y
    /// mean nothing for z <= 0.
    Vec3 project(Vec3 point) const;
    Vec3 forward() const { return forward_; }
    /// Side of a pixel at distance 1 along the axis.
    double pixel() const { return glm::length(dx_); }
    Vec3 eye() const { return eye_; }

private:
    Vec3 eye_, forward_, corner_, dx_, dy_;
};

}  // namespace deburr
