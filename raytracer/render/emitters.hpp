// The emitters that the path integrator samples: lights, glowing solids, and the environment.
//
// A solid of any shape is sampled by the cone around its bounding ball: a direction that misses the solid adds nothing,
// so no mesh of it is needed and the estimate is unbiased. Solids that are unbounded, or too large to be bounded in
// time, are found by scattered rays only.
//
// If there are many emitters, a tree (light_tree.hpp) chooses one by importance without evaluating all.
#pragma once
#include <optional>
#include <vector>

#include "raytracer/render/lights.hpp"

namespace deburr {

/// All emitters of a scene, by index.
class Emitters {
public:
    /// Keeps a reference to `sky`.
    Emitters(const Scene& scene, const SkyLight& sky);

    std::size_t size() const { return sun_ + (sky_.sun().shines() ? 1 : 0); }
    /// Whether only a single direction leads to it, so that scattered rays cannot find it.
    bool single(std::size_t i) const { return i < lights_.size() && !lights_[i].extended(); }
    /// An estimate of the light that an emitter (or all together) gives at a point; 0 only if at() would find none.
    double importance(std::size_t i, Vec3 point) const;
    double importance(Vec3 point) const;
    /// Chooses an emitter for a uniform u in [0, 1), with a probability proportional to its importance. `importance` is
    /// importance(point) and > 0. Returns none if the remaining candidates give no light.
    std::optional<std::size_t> choose(Vec3 point, double importance, double u) const;

    /// A sample of an emitter.
    struct Sample : Incident {
        // ≥ 0: index of a glowing solid, whose emission the ray has to find; irradiance is then 1/density
        int solid = -1;
    };
    /// A sample of emitter i as seen from a point, for a uniform u in the unit square.
    Sample at(std::size_t i, Vec3 point, Vec2 u) const;

    /// An emitter that a ray meets.
    struct Met {
        // Radiance towards the ray's origin.
        Vec3 radiance{0.0};
        double density = 0.0;  // of at() for this direction; 0: at() does not find it
        double t = infinity;
        std::size_t emitter = 0;
    };
    /// The nearest visible light that the ray meets in (0, t_max), which hides everything behind it.
    Met met(const Ray& ray, double t_max) const;
    /// Whether the ray meets a visible light other than `emitter` in (0, t_max).
    bool hidden(const Ray& ray, double t_max, std::size_t emitter) const;
    /// Calls each(Met) for the invisible lights that the ray meets in (0, t_max).
    template <class Each>
    void for_each_invisible(const Ray& ray, double t_max, Each each) const {
        for_each_met(invisible_, ray, t_max, [&](std::size_t i) {
            const LightSource::Emission e = lights_[i].seen(ray, t_max);
            if (e.density > 0) each(Met{e.radiance, e.density, e.t, i});
        });
    }
    /// The emitter that samples a glowing solid, and the density with which it finds directions to it from `point`.
    struct OfSolid {
        std::size_t emitter;
        double density;
    };
    /// None if the solid is not sampled.
    std::optional<OfSolid> of_solid(int solid, Vec3 point) const;
    /// Calls each(Met) for the emitters of a ray that hits nothing: the sky, and the sun if the ray leads to it.
    template <class Each>
    void for_each_at_infinity(Vec3 direction, Each each) const {
        each(Met{sky_.towards(direction), sky_.sampled() ? sky_.density(direction) : 0.0, infinity, first_sky_});
        if (sky_.sun().covers(direction)) each(Met{sky_.sun().radiance, sky_.sun().density(), infinity, sun_});
    }

private:
    // The bounding ball of a glowing solid, and the mean of its emission.
    struct Ball {
        int solid;
        Vec3 center;
        double radius, emitted;
    };
    double importance_by_itself(std::size_t i, Vec3 point) const;
    // Extended lights, visible or invisible, as indices in lights_, with a tree over them if they are many.
    struct Extended {
        std::vector<std::size_t> lights;
        LightTree tree;
    };
    void plant_tree(const Scene& scene);
    static void plant(Extended& extended, const std::vector<LightSource>& lights);
    // Calls each(i) for the lights that a ray may meet.
    template <class Each>
    static void for_each_met(const Extended& extended, const Ray& ray, const double& t_max, Each each) {
        if (extended.tree.empty())
            for (const std::size_t i : extended.lights) each(i);
        else
            extended.tree.for_each_near(ray, t_max, [&](std::size_t k) { each(extended.lights[k]); });
    }

    std::vector<LightSource> lights_;
    std::vector<Ball> balls_;
    std::vector<int> ball_of_;  // by solid; −1: none
    Extended visible_, invisible_;
    // If there are many: a tree over the emitters that have a position; the others are evaluated one by one.
    LightTree tree_;
    std::vector<std::size_t> in_tree_, others_;
    std::vector<std::int64_t> place_in_tree_;  // by emitter; −1: one of others_
    const SkyLight& sky_;
    std::size_t first_sky_ = 0, sun_ = 0;  // indices of emitters: the sky, if it is sampled, and the sun
};

}  // namespace deburr
