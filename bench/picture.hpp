// Pictures of scenes on one thread, and the rays they are made of.
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/trace/ray_tracer.hpp"
#include "raytracer/util/cpu_time.hpp"

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

/// Every ray that a picture asks for, in the order it does and together with those it does, to be asked again
/// of any tracer.
class Recording final : public RayTracer {
public:
    struct Question {
        std::vector<Ray> rays;
        std::vector<double> t_max;  // empty: infinity
        bool any, alone;
    };

    explicit Recording(const RayTracer& tracer) : tracer_(tracer) {}
    Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        questions_.push_back({{ray}, {t_max}, false, true});
        return tracer_.closest_hit(ray, t_max, counters);
    }
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        questions_.push_back({{ray}, {t_max}, true, true});
        return tracer_.any_hit(ray, t_max, counters);
    }
    void closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const override {
        questions_.push_back({{rays.begin(), rays.end()}, {}, false, false});
        tracer_.closest_hits(rays, hits, counters);
    }
    void any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                  TraceCounters& counters) const override {
        questions_.push_back({{rays.begin(), rays.end()}, {t_max.begin(), t_max.end()}, true, false});
        tracer_.any_hits(rays, t_max, occluded, counters);
    }
    std::size_t rays() const {
        std::size_t sum = 0;
        for (const Question& q : questions_) sum += q.rays.size();
        return sum;
    }
    const std::vector<Question>& questions() const { return questions_; }
    /// Ray by ray, though they were asked together.
    void ask_alone(const RayTracer& tracer, TraceCounters& counters) const {
        for (const Question& q : questions_)
            for (std::size_t i = 0; i < q.rays.size(); ++i) {
                const double t_max = q.t_max.empty() ? infinity : q.t_max[i];
                if (q.any)
                    keep(tracer.any_hit(q.rays[i], t_max, counters));
                else
                    keep(tracer.closest_hit(q.rays[i], t_max, counters));
            }
    }
    void ask(const RayTracer& tracer, TraceCounters& counters) const {
        std::vector<Hit> hits(most());
        const std::unique_ptr<bool[]> occluded(new bool[most()]);
        for (const Question& q : questions_) {
            if (q.alone && q.any)
                keep(tracer.any_hit(q.rays[0], q.t_max[0], counters));
            else if (q.alone)
                keep(tracer.closest_hit(q.rays[0], q.t_max[0], counters));
            else if (q.any)
                tracer.any_hits(q.rays, q.t_max, occluded.get(), counters);
            else
                tracer.closest_hits(q.rays, hits.data(), counters);
        }
        keep(hits);
        keep(occluded);
    }

private:
    std::size_t most() const {
        std::size_t most = 1;
        for (const Question& q : questions_) most = std::max(most, q.rays.size());
        return most;
    }
    const RayTracer& tracer_;
    mutable std::vector<Question> questions_;
};

}  // namespace deburr::bench
