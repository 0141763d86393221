// The camera's rays and the shadow rays of what they hit, traced together.
#include <memory>

#include "raytracer/render/bump.hpp"
#include "raytracer/render/integrator_path.hpp"
#include "raytracer/render/noise_bound.hpp"
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
        std::size_t count = 0;  // of rays and their uses
        std::vector<Ray> rays = std::vector<Ray>(max_rays);
        std::vector<Use> uses = std::vector<Use>(max_rays, Use{Sampler(0, 0, 0, 0), 0, false, false});
        std::vector<Hit> hits = std::vector<Hit>(max_rays);
        std::vector<Vec3> colors = std::vector<Vec3>(max_rays);
        // Of those that hit something opaque; they keep references to the hits.
        std::vector<Surface> surfaces;
        std::vector<std::uint32_t> seen_by;
        std::vector<Vec3> lit = std::vector<Vec3>(max_rays), here = lit;
        // To one light.
        std::size_t asked = 0;  // shadow rays
        std::vector<Ray> shadows = std::vector<Ray>(max_rays);
        std::vector<double> t_max = std::vector<double>(max_rays);
        std::vector<Unhidden> unhidden = std::vector<Unhidden>(max_rays);
        std::unique_ptr<bool[]> hidden{new bool[max_rays]};
    };

    CameraRays(const Integrator& integrator, PixelSums* sums, LayerSums* layers, TraceCounters& counters,
               Memory& memory)
        : in_(integrator), sums_(sums), layers_(layers), counters_(counters), m_(memory) {
        clear();
    }

    // Into its place at once: what is put together elsewhere and then copied waits for its parts.
    void add(Ray ray, const Use& use) {
        m_.rays[m_.count] = ray;
        m_.uses[m_.count++] = use;
        if (m_.count == max_rays) finish();
    }

    /// Of all rays so far.
    void finish() {
        in_.tracer_.closest_hits({m_.rays.data(), m_.count}, m_.hits.data(), counters_);
        for (std::uint32_t i = 0; i < m_.count; ++i) take(i);
        std::fill_n(m_.lit.begin(), m_.surfaces.size(), Vec3(0.0));
        light();
        for (std::size_t j = 0; j < m_.surfaces.size(); ++j)
            m_.colors[m_.seen_by[j]] = in_.color_of(m_.surfaces[j], m_.lit[j], path(m_.seen_by[j]));
        for (std::size_t i = 0; i < m_.count; ++i)
            if (m_.uses[i].sample) sums_[m_.uses[i].pixel].color += finite_or_zero(m_.colors[i]);
        clear();
    }

private:
    void clear() {
        m_.count = 0;
        m_.surfaces.clear();
        m_.seen_by.clear();
    }

    Path path(std::uint32_t i) const { return {.sampler = m_.uses[i].sampler, .counters = counters_}; }

    void take(std::uint32_t i) {
        const Hit& hit = m_.hits[i];
        const Vec3 direction = m_.rays[i].direction;
        const Use& use = m_.uses[i];
        LayerSums* layers = layers_ ? layers_ + use.pixel : nullptr;
        if (use.center && layers && hit) layers->set_center(hit, direction, in_.camera_.forward());
        if (!use.sample) return;
        if (!hit) {
            m_.colors[i] = in_.settings_.background ? in_.seen_.towards(direction) : Vec3(0.0);
            return;
        }
        const Vec3 albedo = in_.texture_color(hit);
        ++sums_[use.pixel].hits;
        if (layers) {
            layers->albedo += finite_or_zero(albedo);
            const Vec3 normal = shading_normal(in_.material(hit), hit.position, hit.normal, -direction);
            layers->guide_normal += finite_or_zero(glm::dot(normal, direction) > 0 ? -normal : normal);
            layers->rest.solids.add(std::uint32_t(hit.solid + 1));
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
        m_.asked = 0;
        for (std::uint32_t j = 0; j < m_.surfaces.size(); ++j) {
            const Surface& surface = m_.surfaces[j];
            const Incident light =
                incident(source, surface.hit, m_.uses[m_.seen_by[j]].sampler, number, k, source.samples());
            const Vec3 scattered = in_.scattered(surface, light);
            if (!(brightest(scattered) > 0)) continue;
            m_.shadows[m_.asked] = leave(surface.hit, light.direction);
            m_.t_max[m_.asked] = light.distance;
            m_.unhidden[m_.asked++] = {scattered, j};
        }
        in_.tracer_.any_hits({m_.shadows.data(), m_.asked}, {m_.t_max.data(), m_.asked}, m_.hidden.get(), counters_);
        for (std::size_t s = 0; s < m_.asked; ++s)
            if (!m_.hidden[s]) m_.here[m_.unhidden[s].surface] += m_.unhidden[s].light;
    }

    const Integrator& in_;
    PixelSums* sums_;
    LayerSums* layers_;
    TraceCounters& counters_;
    Memory& m_;
};

void Integrator::take(SampleRange range, const Window& block, PixelSums* sums, LayerSums* layers,
                      TraceCounters& counters) const {
    if (paths_) return paths_->take(range, block, sums, layers, counters);
    const bool is_centered = settings_.spp <= 1;
    const bool apart = layers && settings_.cost;
    thread_local CameraRays::Memory memory;
    CameraRays rays(*this, sums, layers, counters, memory);
    std::uint64_t evaluations = counters.evaluations;
    const auto pixel = [&](int x, int y) {
        const auto i = std::uint32_t(y * block.width + x);
        x += block.x;
        y += block.y;
        if (range.first == 0 && (is_centered || layers))
            rays.add(camera_.ray(x + 0.5, y + 0.5), {Sampler(settings_.seed, x, y, 0), i, true, is_centered});
        for (int s = range.first; !is_centered && s < range.end; ++s) {
            const Sampler sampler(settings_.seed, x, y, s);
            const Vec2 offset = filter_offset(sampler.square(lens));
            rays.add(camera_.ray(x + 0.5 + offset.x, y + 0.5 + offset.y), {sampler, i, false, true});
        }
        sums[i].samples += std::uint32_t(range.end - range.first);
        if (!apart) return;
        rays.finish();
        layers[i].rest.cost += double(counters.evaluations - evaluations);
        evaluations = counters.evaluations;
    };
    for (int top = 0; top < block.height; top += patch)
        for (int left = 0; left < block.width; left += patch)
            for (int y = top; y < std::min(top + patch, block.height); ++y)
                for (int x = left; x < std::min(left + patch, block.width); ++x) pixel(x, y);
    rays.finish();
}

void Integrator::block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const {
    const Window window = settings_.noise > 0 ? grown_to_cells(block, settings_.width, settings_.height) : block;
    thread_local std::vector<PixelSums> sums;
    thread_local std::vector<LayerSums> layer_sums;
    thread_local std::vector<ColorSum> halves;
    const std::size_t count = std::size_t(window.width) * std::size_t(window.height);
    sums.assign(count, {});
    layer_sums.assign(layers ? count : 0, {});
    halves.assign(settings_.noise > 0 ? count : 0, {});
    const SampleArrays arrays{sums.data(), layers ? layer_sums.data() : nullptr, halves.data()};
    const SampleRange all{0, std::max(1, settings_.spp)};
    if (settings_.noise > 0)
        for (SampleRange pass = next_pass(all, 0); pass.first < all.end; pass = next_pass(all, pass.end))
            take_until_quiet(*this, settings_.noise, pass, window, arrays, counters);
    else
        take(all, window, arrays.sums, arrays.layers, counters);
    for (int y = 0; y < block.height; ++y)
        for (int x = 0; x < block.width; ++x) {
            const std::size_t from =
                std::size_t(block.y - window.y + y) * std::size_t(window.width) + std::size_t(block.x - window.x + x);
            *pixels++ = mean(sums[from]);
            if (layers) *layers++ = mean(layer_sums[from], sums[from].samples);
        }
}

Pixel Integrator::pixel(int x, int y, PixelLayers* layers, TraceCounters& counters) const {
    Pixel pixel;
    block({x, y, 1, 1}, &pixel, layers, counters);
    return pixel;
}

}  // namespace deburr
