// Traces the camera rays of a block, and the shadow rays of their hits, together.
#include <memory>

#include "raytracer/render/integrator_path.hpp"
#include "raytracer/render/noise_bound.hpp"
#include "raytracer/render/path_integrator.hpp"

namespace deburr {
namespace {

// Side of a patch of pixels whose rays are traced together; at one sample, a packet.
constexpr int patch = 4;
// Camera rays of a batch: several packets, whose hits fit into the processor's cache.
constexpr std::size_t max_rays = 128;

// Calls pixel(x, y, i) for all pixels of a block, patch by patch; i is the index row by row.
template <class Each>
void for_patches(const Window& block, Each pixel) {
    for (int top = 0; top < block.height; top += patch)
        for (int left = 0; left < block.width; left += patch)
            for (int y = top; y < std::min(top + patch, block.height); ++y)
                for (int x = left; x < std::min(left + patch, block.width); ++x)
                    pixel(block.x + x, block.y + y, std::uint32_t(y * block.width + x));
}

}  // namespace

class Integrator::CameraRays {
public:
    // The use of a camera ray's result.
    struct Use {
        int x, y, sample;     // determine the random numbers
        std::uint32_t pixel;  // index in the block
        bool center, counts;  // for layers of the center's ray; for the colour
    };
    // The memory of a batch.
    struct Memory {
        std::size_t count = 0;  // number of rays
        std::vector<Ray> rays = std::vector<Ray>(max_rays);
        std::vector<Use> uses = std::vector<Use>(max_rays);
        std::vector<Hit> hits = std::vector<Hit>(max_rays);
        std::vector<Vec3> colors = std::vector<Vec3>(max_rays);
        std::vector<Sampler> samplers;  // of all rays, if lights are sampled
        // Opaque surfaces that were hit, and the ray that sees each.
        SurfaceRoom<max_rays> surfaces;
        std::array<std::uint32_t, max_rays> seen_by;
    };

    // The thread's memory, which is reused for every block.
    static Memory& memory() {
        thread_local Memory of_thread;
        return of_thread;
    }
    // The destination of samples: sums, or to pixels with one sample each. `layers` may be null.
    struct Film {
        PixelSums* sums = nullptr;
        Pixel* pixels = nullptr;
        LayerSums* layers = nullptr;
    };

    CameraRays(const Integrator& integrator, const Film& film, TraceCounters& counters, Memory& memory)
        : in_(integrator), film_(film), counters_(counters), m_(memory) {
        clear();
    }

    // Written in place: a ray that is assembled elsewhere and then copied would wait for its parts.
    void add(Ray ray, const Use& use) {
        m_.rays[m_.count] = ray;
        m_.uses[m_.count++] = use;
        if (m_.count == max_rays) finish();
    }

    /// Traces and shades all rays so far.
    void finish() {
        in_.tracer_.closest_hits({m_.rays.data(), m_.count}, m_.hits.data(), counters_);
        for (std::uint32_t i = 0; i < m_.count; ++i) take(i);
        if (m_.surfaces.count > 0) {
            const Surfaces surfaces = m_.surfaces.surfaces();
            if (in_.samples_lights_)
                for (std::size_t i = 0; i < m_.count; ++i) m_.samplers.push_back(sampler(i));
            in_.shade(surfaces, [this](std::size_t j) { return path(m_.seen_by[j]); });
            for (std::size_t j = 0; j < m_.surfaces.count; ++j)
                m_.colors[m_.seen_by[j]] = surfaces.batch.vec(SurfaceField::shaded, j);
        }
        for (std::size_t i = 0; i < m_.count; ++i)
            if (m_.uses[i].counts) add_to_film(m_.uses[i].pixel, bool(m_.hits[i]), finite_or_zero(m_.colors[i]));
        clear();
    }

private:
    void clear() {
        m_.count = 0;
        m_.surfaces.count = 0;
        m_.samplers.clear();
    }

    void add_to_film(std::uint32_t pixel, bool hit, Vec3 color) {
        if (film_.pixels) {
            for (int k = 0; k < 3; ++k) film_.pixels[pixel].color[k] = ExactSum::rounded(color[k]);
            film_.pixels[pixel].alpha = hit;
            return;
        }
        film_.sums[pixel].color += color;
        film_.sums[pixel].hits += hit;
    }

    Sampler sampler(std::size_t i) const {
        const Use& use = m_.uses[i];
        return Sampler(in_.settings_.seed, use.x, use.y, use.sample);
    }

    Path path(std::uint32_t i) const {
        return {.sampler = m_.samplers.empty() ? sampler(i) : m_.samplers[i], .counters = counters_};
    }

    void take(std::uint32_t i) {
        const Hit& hit = m_.hits[i];
        const Vec3 direction = m_.rays[i].direction;
        const Use& use = m_.uses[i];
        LayerSums* layers = film_.layers ? film_.layers + use.pixel : nullptr;
        if (use.center && layers && hit) layers->set_center(hit, direction, in_.camera_.forward());
        if (!use.counts) return;
        if (!hit) {
            m_.colors[i] = in_.settings_.background ? in_.seen_.towards(direction) : Vec3(0.0);
            return;
        }
        const Vec3 albedo = in_.texture_color(hit);
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
        m_.seen_by[m_.surfaces.count] = i;
        in_.add(m_.surfaces, hit, albedo, direction);
    }

    const Integrator& in_;
    const Film film_;
    TraceCounters& counters_;
    Memory& m_;
};

void Integrator::take(SampleRange range, const Window& block, PixelSums* sums, LayerSums* layers,
                      TraceCounters& counters) const {
    if (paths_) return paths_->take(range, block, sums, layers, counters);
    const bool is_centered = settings_.spp <= 1;
    const bool apart = layers && settings_.cost;
    CameraRays rays(*this, {.sums = sums, .layers = layers}, counters, CameraRays::memory());
    std::uint64_t evaluations = counters.evaluations;
    for_patches(block, [&](int x, int y, std::uint32_t i) {
        if (range.first == 0 && (is_centered || layers))
            rays.add(camera_.ray(x + 0.5, y + 0.5), {x, y, 0, i, true, is_centered});
        for (int s = range.first; !is_centered && s < range.end; ++s) {
            const Sampler sampler(settings_.seed, x, y, s);
            const Vec2 offset = filter_offset(sampler.square(lens));
            rays.add(camera_.ray(x + 0.5 + offset.x, y + 0.5 + offset.y), {x, y, s, i, false, true});
        }
        sums[i].samples += std::uint32_t(range.end - range.first);
        if (!apart) return;
        rays.finish();
        layers[i].rest.cost += double(counters.evaluations - evaluations);
        evaluations = counters.evaluations;
    });
    rays.finish();
}

void Integrator::take_centers(const Window& block, Pixel* pixels, TraceCounters& counters) const {
    CameraRays rays(*this, {.pixels = pixels}, counters, CameraRays::memory());
    for_patches(block, [&](int x, int y, std::uint32_t i) {
        rays.add(camera_.ray(x + 0.5, y + 0.5), {x, y, 0, i, true, true});
    });
    rays.finish();
}

void Integrator::block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const {
    if (!paths_ && !layers && settings_.spp <= 1 && !(settings_.noise > 0))
        return take_centers(block, pixels, counters);
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
