// What the path integrator takes light from by sampling: lights, solids that glow, and the environment.
//
// A solid of any shape is sampled by the cone around the ball that holds it: a direction that misses the solid brings
// nothing, so no mesh of it is needed and the estimate is unbiased. Solids that are unbounded, or too large to be
// bounded in time, are found by reflections alone.
//
// Many of them are kept in a tree (light_tree.hpp), in which one is found by its importance without asking all.
#pragma once
#include <optional>
#include <vector>

#include "raytracer/render/lights.hpp"

namespace deburr {

class Emitters {
public:
    /// Keeps a reference to the sky.
    Emitters(const Scene& scene, const SkyLight& sky);

    std::size_t size() const { return sun_ + (sky_.sun().shines() ? 1 : 0); }
    /// Whether one direction alone leads to it: then reflections do not find it.
    bool single(std::size_t i) const { return i < lights_.size() && !lights_[i].extended(); }
    /// About as much light as it gives at a point; 0 only where it gives none that at() finds.
    double importance(std::size_t i, Vec3 point) const;
    double importance(Vec3 point) const;
    /// One of them for an even u from 0 to 1, as often as its part of all importance is; none where those left give
    /// nothing. `importance` is that of all at the point, and more than 0.
    std::optional<std::size_t> choose(Vec3 point, double importance, double u) const;

    struct Sample : Incident {
        int solid = -1;  // ≥ 0: the ray has to find what this solid emits; irradiance is then 1/density
    };
    Sample at(std::size_t i, Vec3 point, Vec2 u) const;

    /// An emitter that a ray meets.
    struct Met {
        Vec3 radiance{0.0};
        double density = 0.0;  // with which at() would have found the direction; 0: it would not
        double t = infinity;
        std::size_t emitter = 0;
    };
    /// The nearest visible light at a distance in (0, t_max), which hides what is behind it.
    Met met(const Ray& ray, double t_max) const;
    /// Whether a visible light other than `emitter` is there.
    bool hidden(const Ray& ray, double t_max, std::size_t emitter) const;
    /// Calls each(met) for the invisible ones.
    template <class Each>
    void for_each_invisible(const Ray& ray, double t_max, Each each) const {
        for_each_met(invisible_, ray, t_max, [&](std::size_t i) {
            const LightSource::Emission e = lights_[i].seen(ray, t_max);
            if (e.density > 0) each(Met{e.radiance, e.density, e.t, i});
        });
    }
    /// The emitter that samples a solid, and the density with which it finds a direction to it from `point`.
    struct OfSolid {
        std::size_t emitter;
        double density;
    };
    std::optional<OfSolid> of_solid(int solid, Vec3 point) const;
    /// Calls each(Met) for the emitters that a ray meets if it hits nothing: the sky and, where it is, the sun.
    template <class Each>
    void for_each_at_infinity(Vec3 direction, Each each) const {
        each(Met{sky_.towards(direction), sky_.sampled() ? sky_.density(direction) : 0.0, infinity, first_sky_});
        if (sky_.sun().covers(direction)) each(Met{sky_.sun().radiance, sky_.sun().density(), infinity, sun_});
    }

private:
    struct Ball {
        int solid;
        Vec3 center;
        double radius, emitted;
    };
    double importance_by_itself(std::size_t i, Vec3 point) const;
    // Extended lights, visible or not, by their places in lights_; and whether there are so many that they are in a
    // tree.
    struct Extended {
        std::vector<std::size_t> lights;
        LightTree tree;
    };
    void plant_tree(const Scene& scene);
    static void plant(Extended& extended, const std::vector<LightSource>& lights);
    // Calls each(i) for those that a ray may meet.
    template <class Each>
    static void for_each_met(const Extended& extended, const Ray& ray, const double& t_max, Each each) {
        if (extended.tree.empty())
            for (const std::size_t i : extended.lights) each(i);
        else
            extended.tree.for_each_near(ray, t_max, [&](std::size_t k) { each(extended.lights[k]); });
    }

    std::vector<LightSource> lights_;
    std::vector<Ball> balls_;
    std::vector<int> ball_of_;  // by solid; -1: none
    Extended visible_, invisible_;
    // Where there are many: of those before first_sky_ that are somewhere. The others are asked one by one.
    LightTree tree_;
    std::vector<std::size_t> in_tree_, others_;
    std::vector<std::int64_t> place_in_tree_;  // by emitter; -1: one of the others
    const SkyLight& sky_;
    std::size_t first_sky_ = 0, sun_ = 0;  // emitters: the sky, if it is sampled, and the sun after it
};

}  // namespace deburr
