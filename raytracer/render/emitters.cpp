#include "raytracer/render/emitters.hpp"

#include "bounds/bounding_box.hpp"

namespace deburr {
namespace {

// Glowing solids with more half-spaces are found by scattering only, since bounding them could take longer than the
// picture.
constexpr double max_leaves_bounded = 10'000;

// More emitters than this are put into a tree.
constexpr std::size_t max_in_list = 16;

double mean_of(Vec3 c) { return (c.x + c.y + c.z) / 3; }

}  // namespace

Emitters::Emitters(const Scene& scene, const SkyLight& sky) : sky_(sky) {
    for (const Light& light : scene.lights) {
        const LightSource& source = lights_.emplace_back(light);
        if (source.extended()) (source.visible() ? visible_ : invisible_).lights.push_back(lights_.size() - 1);
    }
    ball_of_.assign(scene.solids.size(), -1);
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
        ball_of_[i] = int(balls_.size());
        balls_.push_back({int(i), 0.5 * (box.lo + box.hi), 0.5 * glm::length(box.hi - box.lo), emitted});
    }
    first_sky_ = lights_.size() + balls_.size();
    sun_ = first_sky_ + (sky.sampled() ? 1 : 0);
    plant(visible_, lights_);
    plant(invisible_, lights_);
    if (size() > max_in_list) plant_tree(scene);
}

void Emitters::plant(Extended& extended, const std::vector<LightSource>& lights) {
    if (extended.lights.size() <= max_in_list) return;
    std::vector<LightBounds> bounds;
    for (const std::size_t i : extended.lights) {
        bounds.push_back(lights[i].bounds());
        bounds.back().power = 1;  // black lights are included, since they hide what is behind them
    }
    extended.tree = LightTree(bounds);
}

void Emitters::plant_tree(const Scene& scene) {
    std::vector<LightBounds> bounds;
    place_in_tree_.assign(size(), -1);
    for (std::size_t i = 0; i < size(); ++i) {
        const bool is_light = i < lights_.size();
        if (i >= first_sky_ || (is_light && scene.lights[i].kind == Light::Kind::directional)) {
            others_.push_back(i);
            continue;
        }
        place_in_tree_[i] = std::int64_t(in_tree_.size());
        in_tree_.push_back(i);
        if (is_light) {
            bounds.push_back(lights_[i].bounds());
        } else {
            const Ball& ball = balls_[i - lights_.size()];
            bounds.push_back({{ball.center - Vec3(ball.radius), ball.center + Vec3(ball.radius)},
                              ball.emitted * pi * ball.radius * ball.radius});
        }
    }
    tree_ = LightTree(bounds);
}

double Emitters::importance_by_itself(std::size_t i, Vec3 point) const {
    if (i < lights_.size()) return lights_[i].importance(point);
    if (i >= sun_) return mean_of(sky_.sun().irradiance());
    if (i >= first_sky_) return pi * mean_of(sky_.average());
    const Ball& ball = balls_[i - lights_.size()];
    const Vec3 to_center = ball.center - point;
    const double square = glm::dot(to_center, to_center), r2 = ball.radius * ball.radius;
    return square > r2 ? ball.emitted * pi * r2 / square : 0.0;
}

double Emitters::importance(std::size_t i, Vec3 point) const {
    if (place_in_tree_.empty() || place_in_tree_[i] < 0) return importance_by_itself(i, point);
    return tree_.importance(std::size_t(place_in_tree_[i]), point);
}

double Emitters::importance(Vec3 point) const {
    double sum = 0;
    if (place_in_tree_.empty()) {
        for (std::size_t i = 0; i < size(); ++i) sum += importance_by_itself(i, point);
        return sum;
    }
    for (const std::size_t i : others_) sum += importance_by_itself(i, point);
    return sum + tree_.importance(point);
}

std::optional<std::size_t> Emitters::choose(Vec3 point, double importance, double u) const {
    double at = u * importance;
    const auto is_next = [&](std::size_t i) {
        const double part = importance_by_itself(i, point);
        at -= part;
        return at < 0 && part > 0;
    };
    if (place_in_tree_.empty()) {
        for (std::size_t i = 0; i < size(); ++i)
            if (is_next(i)) return i;
        return std::nullopt;
    }
    for (const std::size_t i : others_)
        if (is_next(i)) return i;
    const auto chosen = tree_.choose(point, at);
    if (!chosen) return std::nullopt;
    return in_tree_[*chosen];
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
    double end = t_max;
    for_each_met(visible_, ray, end, [&](std::size_t i) {
        const LightSource::Emission e = lights_[i].seen(ray, end);
        if (!(e.t < nearest.t)) return;
        nearest = {e.radiance, e.density, e.t, i};
        end = e.t;
    });
    return nearest;
}

bool Emitters::hidden(const Ray& ray, double t_max, std::size_t emitter) const {
    bool is_hidden = false;
    double end = t_max;
    for_each_met(visible_, ray, end, [&](std::size_t i) {
        if (is_hidden || i == emitter || !(lights_[i].seen(ray, t_max).t < t_max)) return;
        is_hidden = true;
        end = -infinity;  // no other box is near enough
    });
    return is_hidden;
}

std::optional<Emitters::OfSolid> Emitters::of_solid(int solid, Vec3 point) const {
    if (std::size_t(solid) >= ball_of_.size() || ball_of_[solid] < 0) return std::nullopt;
    const auto k = std::size_t(ball_of_[solid]);
    const double d = glm::distance(balls_[k].center, point);
    if (!(d > balls_[k].radius)) return std::nullopt;
    return OfSolid{lights_.size() + k, cone_density(balls_[k].radius, d)};
}

}  // namespace deburr
