// Light that comes straight from its source: point, directional and area lights, and the sky.
//
// Radiometry as in scene.hpp. An area light shines from one side only, a sphere light outward.
#pragma once
#include <array>
#include <numbers>
#include <span>

#include "raytracer/render/light_tree.hpp"
#include "raytracer/render/sampler.hpp"
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// Light that could reach a point from one direction.
struct Incident {
    Vec3 direction{0.0};  // unit, to the light
    double distance = infinity;
    Vec3 irradiance{0.0};       // on a surface that faces it, if nothing is in between;
                                // area: an estimate of it from this one point of the light
    double density = infinity;  // of the direction, per solid angle; infinity: there is only one
};

/// Density per solid angle of the directions in the cone around a ball, as seen from a distance d > r of its center.
double cone_density(double r, double d);
/// One of them, evenly distributed for an even `u`.
Vec3 cone_direction(Vec3 to_center, double r, double d, Vec2 u);

class LightSource {
public:
    explicit LightSource(const Light& light);

    /// Incidents per shading point: 1 where there is only one.
    int samples() const { return samples_; }
    Light::Kind kind() const { return kind_; }
    /// Middle of the light; meaningless for a directional one.
    Vec3 position() const { return position_; }
    /// Direction in which a directional light shines, or the normal of an area.
    Vec3 direction() const { return direction_; }
    /// An area's sides.
    Vec3 u() const { return u_; }
    Vec3 v() const { return v_; }
    double area() const { return area_; }
    /// Radiant intensity of a point, irradiance by a directional one, radiance of an extended one.
    Vec3 emitted() const { return emitted_; }
    bool extended() const { return kind_ == Light::Kind::area || kind_ == Light::Kind::sphere; }
    /// Whether the camera sees it and it hides what is behind it: extended ones alone.
    bool visible() const { return visible_; }
    /// Light that reaches `point` from the place `u` of the light (area: uniform over it; sphere: over its cone).
    /// Irradiance 0 where the light does not shine.
    Incident at(Vec3 point, Vec2 u) const;

    struct Emission {
        Vec3 radiance{0.0};
        double density = 0.0;  // with which at() would have found the ray's direction; 0: it would not
        double t = infinity;   // where the light is met; infinity: it is not
    };
    /// The light itself as the ray sees it at a distance in (0, t_max): extended lights only. An area light is black
    /// from behind, a sphere from within.
    Emission seen(const Ray& ray, double t_max) const;
    /// Irradiance that the light gives at most at a point with nothing in between, by a rough estimate; 0 only where
    /// at() finds nothing. For choosing among lights.
    double importance(Vec3 point) const;
    /// Where the light is and shines, unless it is directional.
    LightBounds bounds() const;

private:
    Light::Kind kind_;
    int samples_ = 1;
    Vec3 position_, direction_;  // direction_: area: its normal
    Vec3 u_, v_;
    Vec3 emitted_;  // point: radiant intensity; directional: irradiance; extended: radiance
    double area_ = 0.0, radius_ = 0.0;
    bool visible_ = false;

    Incident at_sphere(Vec3 point, Vec2 u) const;
    Emission sphere_seen(const Ray& ray, double t_max) const;
};

/// The background, and the light that surfaces get from it.
class SkyLight {
public:
    explicit SkyLight(const Background& background);

    /// Radiance from this unit direction, without the sun.
    Vec3 towards(Vec3 direction) const {
        return picture_ ? picture_towards(direction) : background_.towards(direction);
    }
    /// Mean radiance, weighted by the cosine, over the hemisphere around a unit normal, without the sun:
    /// irradiance/π of a surface that sees nothing but sky. Off by less than 10⁻³ of zenith −
    /// horizon; of a picture, by spherical harmonics of three orders [Ramamoorthi & Hanrahan 2001].
    Vec3 mean(Vec3 normal) const;

    /// The sun by day: a disc far away.
    struct Sun {
        Vec3 direction{0, 1, 0}, radiance{0.0};
        double depth = 0;  // 1 − cosine of its radius

        bool shines() const { return depth > 0; }
        double density() const { return 1 / (2 * std::numbers::pi * depth); }
        bool covers(Vec3 towards) const { return shines() && glm::dot(towards, direction) >= 1 - depth; }
        Vec3 at(Vec2 u) const;
        Vec3 irradiance() const { return radiance / density(); }
    };
    const Sun& sun() const { return sun_; }

    /// A gradient or a single colour, unless directions are sampled.
    const Background& background() const { return background_; }

    /// Whether directions are sampled by brightness: of pictures and by day.
    bool sampled() const { return picture_ != nullptr; }
    Vec3 sample(Vec2 u) const;
    /// Per solid angle, of what sample() finds.
    double density(Vec3 direction) const;
    /// Over all directions.
    Vec3 average() const { return harmonics_[0]; }

    /// The zenith's share of a gradient's mean, at normals of height 2 i / n − 1, i from 0 to n.
    std::span<const double> zenith_shares() const { return zenith_share_; }

private:
    Vec3 picture_towards(Vec3 direction) const;
    Vec2 place_of(Vec3 direction) const;  // in the picture, from 0 to 1
    Vec3 direction_of(Vec2 place) const;
    void prepare_picture();

    static constexpr int steps = 64;
    Background background_;
    std::array<double, steps + 1> zenith_share_{};  // by the normal's height, from -1 to 1
    std::shared_ptr<const PictureData> picture_;
    double cos_rotate_ = 1, sin_rotate_ = 0;
    std::vector<double> rows_, columns_;  // shares of all rows above; in each row, of all columns before
    double total_ = 0;
    std::array<Vec3, 9> harmonics_{};  // means of polynomials of the direction over all of them
    Sun sun_;
};

}  // namespace deburr
