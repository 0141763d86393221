// The camera: from points of the picture to rays, and from points of the world to the picture. A pinhole, unless the
// scene gives it a lens; with parallel rays if the scene wants so.
#pragma once
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

class PinholeCamera {
public:
    PinholeCamera(const Camera& camera, int width, int height);
    /// Ray through a point of the picture, in pixels: (x + ½, y + ½) is the centre of pixel (x, y).
    Ray ray(double x, double y) const {
        const Vec3 on_picture = corner_ + x * dx_ + y * dy_;
        if (orthographic_) return {eye_ + (on_picture - forward_), forward_};
        return {eye_, glm::normalize(on_picture)};
    }
    /// Ray from a point of the lens, by `u` in the unit square, through the point in focus that (x, y) shows.
    Ray ray(double x, double y, Vec2 u) const;
    bool has_lens() const { return lens_radius_ > 0; }
    /// Where a point is seen: x and y as ray() takes them, and z its distance along the axis; x and y
    /// mean nothing for z <= 0.
    Vec3 project(Vec3 point) const;
    Vec3 forward() const { return forward_; }
    /// Side of a pixel at a distance along the axis.
    double pixel(double distance) const { return glm::length(dx_) * (orthographic_ ? 1 : distance); }
    Vec3 eye() const { return eye_; }
    bool orthographic() const { return orthographic_; }
    /// Vector from a point in front of the camera to where the ray through it began.
    Vec3 to_eye(Vec3 point) const;

private:
    bool orthographic_;
    // The picture's corner and its pixels' sides at distance 1; in an orthographic one, at any distance.
    Vec3 eye_, forward_, corner_, dx_, dy_;
    double lens_radius_, focus_;
};

}  // namespace deburr
