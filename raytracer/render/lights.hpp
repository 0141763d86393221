// Light sources: point, directional, area and sphere lights, and the sky.
//
// Radiometry is that of scene.hpp. An area light emits on one side only, a sphere light outward.
#pragma once
#include <array>
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
    Vec3 irradiance{0.0};       // on a surface that faces it, without occlusion;
                                // if the light is extended, an estimate from this one point of it
    double density = infinity;  // of the direction, per solid angle; infinity: the only one
};

/// The density per solid angle of uniform directions in the cone around a ball of radius r, at distance d > r of its
/// center.
double cone_density(double r, double d);
/// A uniform direction in that cone, for a uniform `u` in the unit square.
Vec3 cone_direction(Vec3 to_center, double r, double d, Vec2 u);

/// A light of the scene, prepared for sampling.
class LightSource {
public:
    explicit LightSource(const Light& light);

    /// Samples per shading point in previews; 1 unless the light is extended.
    int samples() const { return samples_; }
    Light::Kind kind() const { return kind_; }
    /// Center of the light; undefined for a directional one.
    Vec3 position() const { return position_; }
    /// Direction in which a directional light travels, or an area light's normal.
    Vec3 direction() const { return direction_; }
    /// The sides of an area light.
    Vec3 u() const { return u_; }
    Vec3 v() const { return v_; }
    double area() const { return area_; }
    /// Radiant intensity of a point light, irradiance of a directional one, radiance of an extended one.
    Vec3 emitted() const { return emitted_; }
    bool extended() const { return kind_ == Light::Kind::area || kind_ == Light::Kind::sphere; }
    /// Whether the camera sees it and it hides what is behind it; extended lights only.
    bool visible() const { return visible_; }
    /// The light that reaches `point` from the place `u` of the light (area: uniform on it; sphere: uniform in its
    /// cone). The irradiance is 0 where the light does not shine.
    Incident at(Vec3 point, Vec2 u) const;

    /// The emission of a light along a ray.
    struct Emission {
        Vec3 radiance{0.0};
        double density = 0.0;  // of at() for the ray's direction; 0: at() does not find it
        double t = infinity;   // distance; infinity: the ray does not meet the light
    };
    /// The emission of an extended light that the ray meets at a distance in (0, t_max). An area light is black from
    /// behind, a sphere from inside.
    Emission seen(const Ray& ray, double t_max) const;
    /// A rough upper estimate of the unoccluded irradiance at a point, for choosing among lights; 0 only where at()
    /// finds nothing.
    double importance(Vec3 point) const;
    /// Bounds for a LightTree; not for directional lights.
    LightBounds bounds() const;

private:
    Light::Kind kind_;
    int samples_ = 1;
    Vec3 position_, direction_;  // area: its normal
    Vec3 u_, v_;
    Vec3 emitted_;  // point: radiant intensity; directional: irradiance; extended: radiance
    double area_ = 0.0, radius_ = 0.0;
    bool visible_ = false;

    Incident at_sphere(Vec3 point, Vec2 u) const;
    Emission sphere_seen(const Ray& ray, double t_max) const;
};

/// The background as a light: its radiance by direction, and the irradiance on surfaces.
class SkyLight {
public:
    explicit SkyLight(const Background& background);

    /// Radiance from this unit direction, without the sun.
    Vec3 towards(Vec3 direction) const {
        return picture_ ? picture_towards(direction) : background_.towards(direction);
    }
    /// Mean radiance over the hemisphere around a unit normal, weighted by the cosine, without the sun: irradiance/π of
    /// an unoccluded surface. The error is below 10⁻³ of zenith − horizon; for a picture it is computed by spherical
    /// harmonics of three orders [Ramamoorthi & Hanrahan 2001].
    Vec3 mean(Vec3 normal) const;

    /// The sun of a day sky: a distant disc.
    struct Sun {
        Vec3 direction{0, 1, 0}, radiance{0.0};
        double depth = 0;  // 1 − cosine of its angular radius

        bool shines() const { return depth > 0; }
        double density() const { return 1 / (2 * pi * depth); }
        bool covers(Vec3 towards) const { return shines() && glm::dot(towards, direction) >= 1 - depth; }
        /// A uniform direction in the disc, for a uniform `u` in the unit square.
        Vec3 at(Vec2 u) const;
        Vec3 irradiance() const { return radiance / density(); }
    };
    const Sun& sun() const { return sun_; }

    /// The gradient or constant colour; not to be used if directions are sampled.
    const Background& background() const { return background_; }

    /// Whether directions are sampled by brightness: for pictures and day skies.
    bool sampled() const { return picture_ != nullptr; }
    /// A direction with a density proportional to brightness, for a uniform `u` in the unit square.
    Vec3 sample(Vec2 u) const;
    /// Density per solid angle of sample().
    double density(Vec3 direction) const;
    /// Mean radiance over all directions.
    Vec3 average() const { return harmonics_[0]; }

    /// The zenith's share of a gradient's mean(), at normals of height 2 i / n − 1, i = 0 … n.
    std::span<const double> zenith_shares() const { return zenith_share_; }

private:
    Vec3 picture_towards(Vec3 direction) const;
    Vec2 place_of(Vec3 direction) const;  // in the picture, from 0 to 1
    Vec3 direction_of(Vec2 place) const;
    void prepare_picture();

    static constexpr int steps = 64;
    Background background_;
    std::array<double, steps + 1> zenith_share_{};  // by the normal's height, from −1 to 1
    std::shared_ptr<const PictureData> picture_;
    double cos_rotate_ = 1, sin_rotate_ = 0;
    std::vector<double> rows_, columns_;  // sums for sampling: of all rows above; in each row, of all columns before
    double total_ = 0;
    std::array<Vec3, 9> harmonics_{};  // means of polynomials of the direction, weighted by radiance
    Sun sun_;
};

}  // namespace deburr
