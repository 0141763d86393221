#include "raytracer/render/emitters.hpp"

#include <numbers>

#include "bounds/bounding_box.hpp"

namespace deburr {
namespace {

// A solid of more half-spaces is found by reflections alone: to bound it could take longer than the picture.
constexpr double max_leaves_bounded = 10'000;

double mean_of(Vec3 c) { return (c.x + c.y + c.z) / 3; }

}  // namespace

Emitters::Emitters(const Scene& scene, const SkyLight& sky) : sky_(sky) {
    for (const Light& light : scene.lights) {
        const LightSource& source = lights_.emplace_back(light);
        if (source.extended()) (source.visible() ? visible_ : invisible_).push_back(lights_.size() - 1);
    }
    bool any = false;
    for (const Material& m : scene.materials) any = any || mean_of(m.emission) > 0;
    for (std::size_t i = 0; any && i < scene.solids.size(); ++i) {
        if (scene.solids[i].node().leaves > max_leaves_bounded) continue;
        const SolidTree tree = flatten(scene.solids[i]);
        double emitted = 0;
        for (const SolidLeaf& leaf : tree.leaves)
            emitted = std::max(emitted, mean_of(scene.materials[leaf.material].emission));
        if (!(emitted > 0)) continue;
        const Box box = bounding_box(tree);
        if (box.empty() || !box.finite()) continue;
        balls_.push_back({int(i), 0.5 * (box.lo + box.hi), 0.5 * glm::length(box.hi - box.lo), emitted});
    }
    first_sky_ = lights_.size() + balls_.size();
    sun_ = first_sky_ + (sky.sampled() ? 1 : 0);
}

double Emitters::importance(std::size_t i, Vec3 point) const {
    if (i < lights_.size()) return lights_[i].importance(point);
    if (i >= sun_) return mean_of(sky_.sun().irradiance());
    if (i >= first_sky_) return std::numbers::pi * mean_of(sky_.average());
    const Ball& ball = balls_[i - lights_.size()];
    const Vec3 to_center = ball.center - point;
    const double square = glm::dot(to_center, to_center), r2 = ball.radius * ball.radius;
    return square > r2 ? ball.emitted * std::numbers::pi * r2 / square : 0.0;
}

double Emitters::importance(Vec3 point) const {
    double sum = 0;
    for (std::size_t i = 0; i < size(); ++i) sum += importance(i, point);
    return sum;
}

Emitters::Sample Emitters::at(std::size_t i, Vec3 point, Vec2 u) const {
    if (i < lights_.size()) return {lights_[i].at(point, u), -1};
    Sample sample;
    if (i >= first_sky_) {
        const bool sun = i >= sun_;
        sample.direction = sun ? sky_.sun().at(u) : sky_.sample(u);
        sample.density = sun ? sky_.sun().density() : sky_.density(sample.direction);
        if (sample.density > 0)
            sample.irradiance = (sun ? sky_.sun().radiance : sky_.towards(sample.direction)) / sample.density;
        return sample;
    }
    const Ball& ball = balls_[i - lights_.size()];
    const Vec3 to_center = ball.center - point;
    const double d = glm::length(to_center);
    if (!(d > ball.radius)) return sample;
    sample.direction = cone_direction(to_center, ball.radius, d, u);
    sample.density = cone_density(ball.radius, d);
    sample.irradiance = Vec3(1 / sample.density);
    sample.solid = ball.solid;
    return sample;
}

Emitters::Met Emitters::met(const Ray& ray, double t_max) const {
    Met nearest;
    for (const std::size_t i : visible_) {
        const LightSource::Emission e = lights_[i].seen(ray, std::min(t_max, nearest.t));
        if (e.t < nearest.t) nearest = {e.radiance, e.density, e.t, i};
    }
    return nearest;
}

bool Emitters::hidden(const Ray& ray, double t_max, std::size_t emitter) const {
    for (const std::size_t i : visible_)
        if (i != emitter && lights_[i].seen(ray, t_max).t < t_max) return true;
    return false;
}

std::optional<Emitters::OfSolid> Emitters::of_solid(int solid, Vec3 point) const {
    for (std::size_t k = 0; k < balls_.size(); ++k) {
        if (balls_[k].solid != solid) continue;
        const double d = glm::distance(balls_[k].center, point);
        if (!(d > balls_[k].radius)) return std::nullopt;
        return OfSolid{lights_.size() + k, cone_density(balls_[k].radius, d)};
    }
    return std::nullopt;
}

}  // namespace deburr
