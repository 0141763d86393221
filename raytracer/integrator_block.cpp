// The camera's rays and the shadow rays of what they hit, traced together.
#include <memory>

#include "raytracer/path.hpp"

namespace deburr {
namespace {

// Pixels each way whose rays travel together: at one sample, a packet.
constexpr int patch = 4;
// Camera rays at a time: many packets, whose hits fit into the processor's cache.
constexpr std::size_t most_rays = 128;

}  // namespace

// Surfaces keep references to the hits: vectors are as long as they may become from the start.
class Integrator::CameraRays {
public:
    CameraRays(const Integrator& integrator, Pixel* pixels, PixelLayers* layers, TraceCounters& counters)
        : in_(integrator), pixels_(pixels), layers_(layers), counters_(counters), hits_(most_rays), colors_(most_rays), lit_(most_rays), here_(most_rays),
          hidden_(new bool[most_rays]) {
        rays_.reserve(most_rays);
        uses_.reserve(most_rays);
        surfaces_.reserve(most_rays);
        seen_by_.reserve(most_rays);
        shadows_.reserve(most_rays);
        t_max_.reserve(most_rays);
        unhidden_.reserve(most_rays);
    }

    struct Use {
        Sampler sampler;
        std::uint32_t pixel;
        bool center, sample;  // for the layers; for the colour
    };
    void add(const Ray& ray, const Use& use) {
        rays_.push_back(ray);
        uses_.push_back(use);
        if (rays_.size() == most_rays) finish();
    }

    /// Of all rays so far.
    void finish() {
        in_.tracer_.first_hits(rays_, hits_.data(), counters_);
        for (std::uint32_t i = 0; i < rays_.size(); ++i) take(i);
        std::fill_n(lit_.begin(), surfaces_.size(), Vec3(0.0));
        light();
        for (std::size_t j = 0; j < surfaces_.size(); ++j)
            colors_[seen_by_[j]] = in_.color_of(surfaces_[j], lit_[j], path(seen_by_[j]));
        // In their order: a pixel's sum does not depend on what travels with it.
        for (std::size_t i = 0; i < rays_.size(); ++i)
            if (uses_[i].sample) pixels_[uses_[i].pixel].color += finite_or_zero(colors_[i]);
        rays_.clear();
        uses_.clear();
        surfaces_.clear();
        seen_by_.clear();
    }

private:
    Path path(std::uint32_t i) const {
        Path path{.sampler = uses_[i].sampler, .counters = counters_};
        path.without_noise = in_.settings_.spp <= 1;
        return path;
    }

    void take(std::uint32_t i) {
        const Hit& hit = hits_[i];
        const Vec3 direction = rays_[i].direction;
        const Use& use = uses_[i];
        PixelLayers* layers = layers_ ? layers_ + use.pixel : nullptr;
        if (use.center && layers && hit) {
            layers->position = finite_or_zero(hit.position);
            layers->normal = finite_or_zero(hit.normal);
            layers->z = hit.t * glm::dot(direction, in_.camera_.forward());
            layers->id = std::uint32_t(hit.solid + 1);
        }
        if (!use.sample) return;
        if (!hit) {
            colors_[i] = in_.sky_.towards(direction);
            return;
        }
        const Vec3 albedo = in_.texture_color(hit);
        pixels_[use.pixel].alpha += 1.0;
        if (layers) layers->albedo += finite_or_zero(albedo);
        if (in_.material(hit).kind == Material::Kind::glass) {
            colors_[i] = in_.color_of_glass(hit, albedo, direction, path(i));
            return;
        }
        surfaces_.emplace_back(in_, hit, albedo, direction, path(i));
        seen_by_.push_back(i);
    }

    // What lit() says of each surface, light by light.
    void light() {
        if (in_.glass_) {  // shadow rays go on through it
            for (std::size_t j = 0; j < surfaces_.size(); ++j) lit_[j] = in_.lit(surfaces_[j], path(seen_by_[j]));
            return;
        }
        std::uint32_t number = first_light;
        for (const LightSource& source : in_.lights_) {
            std::fill_n(here_.begin(), surfaces_.size(), Vec3(0.0));
            for (int k = 0; k < source.samples(); ++k) light(source, number, k);
            const double share = double(source.samples());
            for (std::size_t j = 0; j < surfaces_.size(); ++j) lit_[j] += share == 1 ? here_[j] : here_[j] / share;
            ++number;
        }
    }

    void light(const LightSource& source, std::uint32_t number, int k) {
        shadows_.clear();
        t_max_.clear();
        unhidden_.clear();
        for (std::uint32_t j = 0; j < surfaces_.size(); ++j) {
            const Surface& surface = surfaces_[j];
            const Vec2 u = source.extended() ? uses_[seen_by_[j]].sampler.square(number, k, source.samples()) : Vec2(0.5);
            const Incident light = source.at(surface.hit.position, u);
            const Vec3 scattered = in_.scattered(surface, light, source.samples());
            if (!(brightest(scattered) > 0)) continue;
            shadows_.push_back(leave(surface.hit, light.direction));
            t_max_.push_back(light.distance);
            unhidden_.push_back({scattered, j});
        }
        in_.tracer_.occlusions(shadows_, t_max_, hidden_.get(), counters_);
        for (std::size_t s = 0; s < unhidden_.size(); ++s)
            if (!hidden_[s]) here_[unhidden_[s].surface] += unhidden_[s].light;
    }

    struct Unhidden {
        Vec3 light;  // if nothing is in between
        std::uint32_t surface;
    };

    const Integrator& in_;
    Pixel* pixels_;
    PixelLayers* layers_;
    TraceCounters& counters_;
    std::vector<Ray> rays_;
    std::vector<Use> uses_;
    std::vector<Hit> hits_;
    std::vector<Vec3> colors_;
    // Of those that hit something opaque.
    std::vector<Surface> surfaces_;
    std::vector<std::uint32_t> seen_by_;
    std::vector<Vec3> lit_, here_;
    // To one light.
    std::vector<Ray> shadows_;
    std::vector<double> t_max_;
    std::vector<Unhidden> unhidden_;
    std::unique_ptr<bool[]> hidden_;
};

void Integrator::block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const {
    const std::size_t count = std::size_t(block.width) * std::size_t(block.height);
    std::fill_n(pixels, count, Pixel{});
    if (layers) std::fill_n(layers, count, PixelLayers{});
    const int spp = std::max(1, settings_.spp);
    const bool apart = layers && settings_.cost;
    CameraRays rays(*this, pixels, layers, counters);
    std::uint64_t evaluations = counters.evaluations;
    const auto pixel = [&](int x, int y) {
        const auto i = std::uint32_t(y * block.width + x);
        x += block.x;
        y += block.y;
        if (spp == 1 || layers) rays.add(camera_.ray(x + 0.5, y + 0.5), {Sampler(settings_.seed, x, y, 0), i, true, spp == 1});
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
        if (layers) layers[i].albedo /= spp;
    }
}

Pixel Integrator::pixel(int x, int y, PixelLayers* layers, TraceCounters& counters) const {
    Pixel pixel;
    block({x, y, 1, 1}, &pixel, layers, counters);
    return pixel;
}

}  // namespace deburr
