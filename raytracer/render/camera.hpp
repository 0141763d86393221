// The camera: maps points of the picture to rays, and points of the world to the picture. It is a pinhole unless the
// scene gives it a lens, or orthographic.
#pragma once
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// A camera for a picture of a given size: perspective or orthographic, a pinhole or, if lens_radius is set, a lens.
class ProjectiveCamera {
public:
    ProjectiveCamera(const Camera& camera, int width, int height);
    /// The ray through the point (x, y) of the picture, in pixels: (x + ½, y + ½) is the center of pixel (x, y).
    Ray ray(double x, double y) const {
        const Vec3 on_picture = corner_ + x * dx_ + y * dy_;
        if (orthographic_) return {eye_ + (on_picture - forward_), forward_};
        return {eye_, glm::normalize(on_picture)};
    }
    /// The ray from the point `u` (in the unit square) of the lens through the point of the focal plane that (x, y)
    /// shows.
    Ray ray(double x, double y, Vec2 u) const;
    bool has_lens() const { return lens_radius_ > 0; }
    /// The projection of a point: x and y as for ray(), and as z its distance along the axis. x and y have no meaning
    /// if z
    /// <= 0.
    Vec3 project(Vec3 point) const;
    Vec3 forward() const { return forward_; }
    /// The side of a pixel, as a scene length, at a distance along the axis.
    double pixel(double distance) const { return glm::length(dx_) * (orthographic_ ? 1 : distance); }
    Vec3 eye() const { return eye_; }
    bool orthographic() const { return orthographic_; }
    /// The vector from a point in front of the camera to the origin of the ray that shows it.
    Vec3 to_eye(Vec3 point) const;

private:
    bool orthographic_;
    // The picture's corner and the sides of its pixels at distance 1; if orthographic, at any distance.
    Vec3 eye_, forward_, corner_, dx_, dy_;
    double lens_radius_, focus_;
};

}  // namespace deburr
