// The camera's rays and the shadow rays of what they hit, traced together.
#include "raytracer/path.hpp"

namespace deburr {
namespace {

// Pixels each way whose rays travel together: at one sample, a packet.
constexpr int patch = 4;
// Camera rays at a time: many packets, whose hits fit into the processor's cache.
constexpr std::size_t most_rays = 128;

}  // namespace

class Integrator::CameraRays {
public:
    CameraRays(const Integrator& integrator, Pixel* pixels, PixelLayers* layers, TraceCounters& counters)
        : in_(integrator), pixels_(pixels), layers_(layers), counters_(counters) {
        rays_.reserve(most_rays);
        of_.reserve(most_rays);
        paths_.reserve(most_rays);
        surfaces_.reserve(most_rays);
    }

    struct Use {
        std::size_t pixel;
        bool center, sample;  // for the layers; for the colour
    };
    void add(const Ray& ray, const Sampler& sampler, Use use) {
        rays_.push_back(ray);
        of_.push_back({sampler, use});
        if (rays_.size() == most_rays) finish();
    }

    /// Of all rays so far.
    void finish() {
        hits_.resize(rays_.size());
        colors_.assign(rays_.size(), Vec3(0.0));
        in_.tracer_.first_hits(rays_, hits_.data(), counters_);
        for (std::size_t i = 0; i < rays_.size(); ++i) take(i);
        lit_.assign(surfaces_.size(), Vec3(0.0));
        in_.light(surfaces_, paths_, lit_.data());
        for (std::size_t j = 0; j < surfaces_.size(); ++j)
            colors_[ray_of_[j]] = in_.color_of(surfaces_[j], lit_[j], paths_[j]);
        for (std::size_t i = 0; i < rays_.size(); ++i)
            if (of_[i].use.sample) pixels_[of_[i].use.pixel].color += finite_or_zero(colors_[i]);
        rays_.clear();
        of_.clear();
        paths_.clear();
        surfaces_.clear();
        ray_of_.clear();
    }

private:
    void take(std::size_t i) {
        const Hit& hit = hits_[i];
        const Vec3 direction = rays_[i].direction;
        const Use& use = of_[i].use;
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
        Path path{.sampler = of_[i].sampler, .counters = counters_};
        path.without_noise = in_.settings_.spp <= 1;
        if (in_.material(hit).kind == Material::Kind::glass) {
            colors_[i] = in_.color_of_glass(hit, albedo, direction, path);
            return;
        }
        paths_.push_back(path);
        surfaces_.push_back(in_.surface(hit, albedo, direction, path));
        ray_of_.push_back(i);
    }

    struct Origin {
        Sampler sampler;
        Use use;
    };

    const Integrator& in_;
    Pixel* pixels_;
    PixelLayers* layers_;
    TraceCounters& counters_;
    std::vector<Ray> rays_;
    std::vector<Origin> of_;
    std::vector<Hit> hits_;
    std::vector<Vec3> colors_;
    // Of those that hit something opaque.
    std::vector<Path> paths_;
    std::vector<Surface> surfaces_;
    std::vector<std::size_t> ray_of_;
    std::vector<Vec3> lit_;
};

// What lit() says of each, light by light.
void Integrator::light(const std::vector<Surface>& surfaces, const std::vector<Path>& paths, Vec3* lit) const {
    if (glass_) {  // shadow rays go on through it
        for (std::size_t i = 0; i < surfaces.size(); ++i) lit[i] = this->lit(surfaces[i], paths[i]);
        return;
    }
    std::vector<Ray> rays;
    std::vector<double> t_max;
    std::vector<Vec3> light_here, here;
    std::vector<std::size_t> whose;
    std::unique_ptr<bool[]> hidden(new bool[surfaces.size()]);
    std::uint32_t number = first_light;
    for (const LightSource& source : lights_) {
        const int samples = source.samples();
        here.assign(surfaces.size(), Vec3(0.0));
        for (int k = 0; k < samples; ++k) {
            rays.clear();
            t_max.clear();
            light_here.clear();
            whose.clear();
            for (std::size_t i = 0; i < surfaces.size(); ++i) {
                const Incident light = incident(source, surfaces[i].hit, paths[i], paths[i].dimension(number), k, samples);
                const Vec3 unhidden = scattered(surfaces[i], light, samples);
                if (!(brightest(unhidden) > 0)) continue;
                rays.push_back(leave(surfaces[i].hit, light.direction));
                t_max.push_back(light.distance);
                light_here.push_back(unhidden);
                whose.push_back(i);
            }
            if (rays.empty()) continue;
            tracer_.occlusions(rays, t_max, hidden.get(), paths[0].counters);
            for (std::size_t j = 0; j < rays.size(); ++j)
                if (!hidden[j]) here[whose[j]] += light_here[j];
        }
        for (std::size_t i = 0; i < surfaces.size(); ++i) lit[i] += here[i] / double(samples);
        ++number;
    }
}

void Integrator::block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const {
    const std::size_t count = std::size_t(block.width) * std::size_t(block.height);
    std::fill_n(pixels, count, Pixel{});
    if (layers) std::fill_n(layers, count, PixelLayers{});
    const int spp = std::max(1, settings_.spp);
    const bool apart = layers && settings_.cost;
    CameraRays rays(*this, pixels, layers, counters);
    std::uint64_t evaluations = counters.evaluations;
    const auto pixel = [&](int x, int y) {
        const std::size_t i = std::size_t(y) * std::size_t(block.width) + std::size_t(x);
        x += block.x;
        y += block.y;
        if (spp == 1 || layers) rays.add(camera_.ray(x + 0.5, y + 0.5), Sampler(settings_.seed, x, y, 0), {i, true, spp == 1});
        for (int s = 0; spp > 1 && s < spp; ++s) {
            const Sampler sampler(settings_.seed, x, y, s);
            const Vec2 offset = filter_offset(sampler.square(lens));
            rays.add(camera_.ray(x + 0.5 + offset.x, y + 0.5 + offset.y), sampler, {i, false, true});
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
