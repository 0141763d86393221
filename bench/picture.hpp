// Pictures of scenes on one thread, and the rays they are made of.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "bench/ratio.hpp"
#include "raytracer/integrator.hpp"
#include "raytracer/ray_tracer.hpp"
#include "raytracer/render.hpp"
#include "raytracer/scene_reader.hpp"

namespace deburr::bench {

inline std::string scene_path(const std::string& name) { return DEBURR_SOURCE_DIR "/scenes/" + name + ".lua"; }
inline Scene scene_of(const std::string& name) { return read_scene(scene_path(name), {}); }

inline void render_picture(const Scene& scene, const RayTracer& tracer, TraceCounters& counters, int spp = 1) {
    const Integrator integrator(scene, tracer, {scene.width, scene.height, spp, 0});
    const Window window{0, 0, scene.width, scene.height};
    std::array<Pixel, tile_side * tile_side> pixels;
    for (std::int64_t i = 0; i < tile_count(window); ++i) {
        integrator.block(tile(window, i), pixels.data(), nullptr, counters);
        keep(pixels);
    }
}

/// Every ray that a picture asks for, in the order it does, to be asked again of any tracer.
class Recording final : public RayTracer {
public:
    explicit Recording(const RayTracer& tracer) : tracer_(tracer) {}
    Hit first_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        questions_.push_back({ray, t_max, false});
        return tracer_.first_hit(ray, t_max, counters);
    }
    bool occluded(const Ray& ray, double t_max, TraceCounters& counters) const override {
        questions_.push_back({ray, t_max, true});
        return tracer_.occluded(ray, t_max, counters);
    }
    std::size_t rays() const { return questions_.size(); }
    void ask(const RayTracer& tracer, TraceCounters& counters) const {
        for (const Question& q : questions_) {
            if (q.any) keep(tracer.occluded(q.ray, q.t_max, counters));
            else keep(tracer.first_hit(q.ray, q.t_max, counters));
        }
    }

private:
    struct Question {
        Ray ray;
        double t_max;
        bool any;
    };
    const RayTracer& tracer_;
    mutable std::vector<Question> questions_;
};

}  // namespace deburr::bench
