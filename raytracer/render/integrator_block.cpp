// The camera's rays and the shadow rays of what they hit, traced together.
#include <memory>

#include "raytracer/render/integrator_path.hpp"
#include "raytracer/render/path_integrator.hpp"

namespace deburr {
namespace {

// Pixels each way whose rays travel together: at one sample, a packet.
constexpr int patch = 4;
// Camera rays at a time: many packets, whose hits fit into the processor's cache.
constexpr std::size_t max_rays = 128;

}  // namespace

class Integrator::CameraRays {
public:
    struct Use {
        Sampler sampler;
        std::uint32_t pixel;
        bool center, sample;  // for the layers; for the colour
    };
    struct Unhidden {
        Vec3 light;  // if nothing is in between
        std::uint32_t surface;
    };
    // Lists that a thread uses again for every block.
    struct Memory {
        std::vector<Ray> rays;
        std::vector<Use> uses;
        std::vector<Hit> hits = std::vector<Hit>(max_rays);
        std::vector<Vec3> colors = std::vector<Vec3>(max_rays);
        // Of those that hit something opaque; they keep references to the hits.
        std::vector<Surface> surfaces;
        std::vector<std::uint32_t> seen_by;
        std::vector<Vec3> lit = std::vector<Vec3>(max_rays), here = lit;
        // To one light.
        std::vector<Ray> shadows;
        std::vector<double> t_max;
        std::vector<Unhidden> unhidden;
        std::unique_ptr<bool[]> hidden{new bool[max_rays]};
    };

    CameraRays(const Integrator& integrator, Pixel* pixels, PixelLayers* layers, TraceCounters& counters,
               Memory& memory)
        : in_(integrator), pixels_(pixels), layers_(layers), counters_(counters), m_(memory) {
        clear();
    }

    void add(const Ray& ray, const Use& use) {
        m_.rays.push_back(ray);
        m_.uses.push_back(use);
        if (m_.rays.size() == max_rays) finish();
    }

    /// Of all rays so far.
    void finish() {
        in_.tracer_.closest_hits(m_.rays, m_.hits.data(), counters_);
        for (std::uint32_t i = 0; i < m_.rays.size(); ++i) take(i);
        std::fill_n(m_.lit.begin(), m_.surfaces.size(), Vec3(0.0));
        light();
        for (std::size_t j = 0; j < m_.surfaces.size(); ++j)
            m_.colors[m_.seen_by[j]] = in_.color_of(m_.surfaces[j], m_.lit[j], path(m_.seen_by[j]));
        // In their order: a pixel's sum does not depend on what travels with it.
        for (std::size_t i = 0; i < m_.rays.size(); ++i)
            if (m_.uses[i].sample) pixels_[m_.uses[i].pixel].color += finite_or_zero(m_.colors[i]);
        clear();
    }

private:
    void clear() {
        m_.rays.clear();
        m_.uses.clear();
        m_.surfaces.clear();
        m_.seen_by.clear();
    }

    Path path(std::uint32_t i) const { return {.sampler = m_.uses[i].sampler, .counters = counters_}; }

    void take(std::uint32_t i) {
        const Hit& hit = m_.hits[i];
        const Vec3 direction = m_.rays[i].direction;
        const Use& use = m_.uses[i];
        PixelLayers* layers = layers_ ? layers_ + use.pixel : nullptr;
        if (use.center && layers && hit) {
            layers->position = finite_or_zero(hit.position);
            layers->normal = finite_or_zero(hit.normal);
            layers->z = hit.t * glm::dot(direction, in_.camera_.forward());
            layers->id = std::uint32_t(hit.solid + 1);
        }
        if (!use.sample) return;
        if (!hit) {
            m_.colors[i] = in_.settings_.background ? in_.seen_.towards(direction) : Vec3(0.0);
            return;
        }
        const Vec3 albedo = in_.texture_color(hit);
        pixels_[use.pixel].alpha += 1.0;
        if (layers) {
            layers->albedo += finite_or_zero(albedo);
            layers->solids.add(std::uint32_t(hit.solid + 1));
        }
        if (in_.layers_[hit.material].kind() == Material::Kind::glass) {
            m_.colors[i] = in_.color_of_glass(hit, albedo, direction, path(i));
            return;
        }
        m_.surfaces.emplace_back(in_, hit, albedo, direction);
        m_.seen_by.push_back(i);
    }

    // What lit() says of each surface, light by light.
    void light() {
        if (in_.glass_) {  // shadow rays go on through it
            for (std::size_t j = 0; j < m_.surfaces.size(); ++j)
                m_.lit[j] = in_.lit(m_.surfaces[j], path(m_.seen_by[j]));
            return;
        }
        std::uint32_t number = first_light;
        for (const LightSource& source : in_.lights_) {
            std::fill_n(m_.here.begin(), m_.surfaces.size(), Vec3(0.0));
            for (int k = 0; k < source.samples(); ++k) light(source, number, k);
            const double share = double(source.samples());
            for (std::size_t j = 0; j < m_.surfaces.size(); ++j)
                m_.lit[j] += share == 1 ? m_.here[j] : m_.here[j] / share;
            ++number;
        }
    }

    void light(const LightSource& source, std::uint32_t number, int k) {
        m_.shadows.clear();
        m_.t_max.clear();
        m_.unhidden.clear();
        for (std::uint32_t j = 0; j < m_.surfaces.size(); ++j) {
            const Surface& surface = m_.surfaces[j];
            const Incident light =
                incident(source, surface.hit, m_.uses[m_.seen_by[j]].sampler, number, k, source.samples());
            const Vec3 scattered = in_.scattered(surface, light);
            if (!(brightest(scattered) > 0)) continue;
            m_.shadows.push_back(leave(surface.hit, light.direction));
            m_.t_max.push_back(light.distance);
            m_.unhidden.push_back({scattered, j});
        }
        in_.tracer_.any_hits(m_.shadows, m_.t_max, m_.hidden.get(), counters_);
        for (std::size_t s = 0; s < m_.unhidden.size(); ++s)
            if (!m_.hidden[s]) m_.here[m_.unhidden[s].surface] += m_.unhidden[s].light;
    }

    const Integrator& in_;
    Pixel* pixels_;
    PixelLayers* layers_;
    TraceCounters& counters_;
    Memory& m_;
};

void Integrator::block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const {
    if (paths_) return paths_->block(block, pixels, layers, counters);
    const std::size_t count = std::size_t(block.width) * std::size_t(block.height);
    std::fill_n(pixels, count, Pixel{});
    if (layers) std::fill_n(layers, count, PixelLayers{});
    const int spp = std::max(1, settings_.spp);
    const bool apart = layers && settings_.cost;
    thread_local CameraRays::Memory memory;
    CameraRays rays(*this, pixels, layers, counters, memory);
    std::uint64_t evaluations = counters.evaluations;
    const auto pixel = [&](int x, int y) {
        const auto i = std::uint32_t(y * block.width + x);
        x += block.x;
        y += block.y;
        if (spp == 1 || layers)
            rays.add(camera_.ray(x + 0.5, y + 0.5), {Sampler(settings_.seed, x, y, 0), i, true, spp == 1});
        for (int s = 0; spp > 1 && s < spp; ++s) {
            const Sampler sampler(settings_.seed, x, y, s);
            const Vec2 offset = filter_offset(sampler.square(lens));
            rays.add(camera_.ray(x + 0.5 + offset.x, y + 0.5 + offset.y), {sampler, i, false, true});
        }
        if (!apart) return;
        rays.finish();
        layers[i].cost = double(counters.evaluations - evaluations);
        evaluations = counters.evaluations;
    };
    for (int top = 0; top < block.height; top += patch)
        for (int left = 0; left < block.width; left += patch)
            for (int y = top; y < std::min(top + patch, block.height); ++y)
                for (int x = left; x < std::min(left + patch, block.width); ++x) pixel(x, y);
    rays.finish();
    if (spp == 1) return;
    for (std::size_t i = 0; i < count; ++i) {
        pixels[i].color /= spp;
        pixels[i].alpha /= spp;
        if (!layers) continue;
        layers[i].albedo /= spp;
        layers[i].solids.divide(spp);
    }
}

Pixel Integrator::pixel(int x, int y, PixelLayers* layers, TraceCounters& counters) const {
    Pixel pixel;
    block({x, y, 1, 1}, &pixel, layers, counters);
    return pixel;
}

}  // namespace deburr
