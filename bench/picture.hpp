// Renders scenes on one thread, and records the rays that this takes.
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

/// The path of a scene in scenes/, by its name without extension; and the scene.
inline std::string scene_path(const std::string& name) { return DEBURR_SOURCE_DIR "/scenes/" + name + ".lua"; }
inline Scene scene_of(const std::string& name) { return read_scene(scene_path(name), {}); }

/// Renders the whole picture on this thread.
inline void render_picture(const Scene& scene, const RayTracer& tracer, TraceCounters& counters, int spp = 1) {
    const Integrator integrator(scene, tracer, {scene.width, scene.height, spp, 0});
    const Window window{0, 0, scene.width, scene.height};
    std::array<Pixel, tile_side * tile_side> pixels;
    for (std::int64_t i = 0; i < tile_count(window); ++i) {
        integrator.block(tile(window, i), pixels.data(), nullptr, counters);
        keep(pixels);
    }
}

/// Forwards all rays to a tracer and records them, in order and grouped as they were traced, so that they can be traced
/// again by any tracer. Rays are contiguous in memory, so that replaying them is limited by the tracer.
class Recording final : public RayTracer {
public:
    /// A recorded call.
    struct Question {
        std::size_t first, count;  // range in rays() and t_max()
        bool any, alone;           // any-hit query; a single ray
    };

    explicit Recording(const RayTracer& tracer) : tracer_(tracer) {}
    Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        add({&ray, 1}, {&t_max, 1}, false, true);
        return tracer_.closest_hit(ray, t_max, counters);
    }
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        add({&ray, 1}, {&t_max, 1}, true, true);
        return tracer_.any_hit(ray, t_max, counters);
    }
    void closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const override {
        add(rays, {}, false, false);
        tracer_.closest_hits(rays, hits, counters);
    }
    void any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                  TraceCounters& counters) const override {
        add(rays, t_max, true, false);
        tracer_.any_hits(rays, t_max, occluded, counters);
    }

    const std::vector<Question>& questions() const { return questions_; }
    const std::vector<Ray>& rays() const { return rays_; }
    const std::vector<double>& t_max() const { return t_max_; }

    /// Repeats all calls with another tracer.
    void ask(const RayTracer& tracer, TraceCounters& counters) const {
        std::size_t most = 1;
        for (const Question& q : questions_) most = std::max(most, q.count);
        std::vector<Hit> hits(most);
        const std::unique_ptr<bool[]> occluded(new bool[most]);
        for (const Question& q : questions_) {
            const std::span<const Ray> rays(&rays_[q.first], q.count);
            if (q.alone)
                ask_alone(tracer, q.first, q.any, counters);
            else if (q.any)
                tracer.any_hits(rays, {&t_max_[q.first], q.count}, occluded.get(), counters);
            else
                tracer.closest_hits(rays, hits.data(), counters);
        }
        keep(hits);
        keep(occluded);
    }
    /// Traces all rays one by one, even if they were traced together.
    void ask_alone(const RayTracer& tracer, TraceCounters& counters) const {
        for (const Question& q : questions_)
            for (std::size_t i = q.first; i < q.first + q.count; ++i) ask_alone(tracer, i, q.any, counters);
    }

private:
    void add(std::span<const Ray> rays, std::span<const double> t_max, bool any, bool alone) const {
        if (rays.empty()) return;
        questions_.push_back({rays_.size(), rays.size(), any, alone});
        rays_.insert(rays_.end(), rays.begin(), rays.end());
        t_max_.insert(t_max_.end(), t_max.begin(), t_max.end());
        t_max_.resize(rays_.size(), infinity);
    }
    void ask_alone(const RayTracer& tracer, std::size_t ray, bool any, TraceCounters& counters) const {
        if (any)
            keep(tracer.any_hit(rays_[ray], t_max_[ray], counters));
        else
            keep(tracer.closest_hit(rays_[ray], t_max_[ray], counters));
    }

    const RayTracer& tracer_;
    mutable std::vector<Question> questions_;
    mutable std::vector<Ray> rays_;
    mutable std::vector<double> t_max_;
};

}  // namespace deburr::bench
