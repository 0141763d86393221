#include "raytracer/image/film.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

namespace deburr {
namespace {

void put(ImageLayer layer, const PixelLayers& from, double* to) {
    const auto put_vector = [to](Vec3 v) {
        for (int k = 0; k < 3; ++k) to[k] = v[k];
    };
    switch (layer) {
        case ImageLayer::position: return put_vector(from.position);
        case ImageLayer::normal: return put_vector(from.normal);
        case ImageLayer::albedo: return put_vector(from.albedo);
        case ImageLayer::guide_normal: return put_vector(from.guide_normal);
        case ImageLayer::z: *to = from.z; return;
        case ImageLayer::id: *to = double(from.id); return;
        case ImageLayer::cost: *to = from.cost; return;
        case ImageLayer::cryptomatte: {  // the greatest share first; of equal ones, the lesser id
            std::array<int, SolidShares::ranks> order;
            for (int k = 0; k < SolidShares::ranks; ++k) order[k] = k;
            const SolidShares& s = from.solids;
            std::sort(order.begin(), order.end(), [&](int a, int b) {
                return s.share[a] != s.share[b] ? s.share[a] > s.share[b] : s.id[a] < s.id[b];
            });
            for (const int k : order) {
                *to++ = double(s.id[k]);
                *to++ = s.share[k];
            }
            return;
        }
    }
}

}  // namespace

Film::Film(int full_width, int full_height, Window kept, const std::vector<ImageLayer>& layers)
    : width(full_width), height(full_height), window(kept), pixels(std::size_t(kept.width) * std::size_t(kept.height)) {
    for (const ImageLayer layer : layers) {
        LayerPlane& plane = planes_.try_emplace(layer, layer, pixels.size()).first->second;
        for (std::size_t i = 0; i < pixels.size(); ++i) put(layer, {}, plane.pixel(i));
    }
}

const LayerPlane& Film::layer(ImageLayer layer) const {
    const auto at = planes_.find(layer);
    if (at == planes_.end()) throw std::logic_error("layer " + std::string(layer_name(layer)) + " was not kept");
    return at->second;
}

void Film::set_layers(const Window& block, const PixelLayers* layers) {
    for (auto& [layer, plane] : planes_)
        for (int y = 0; y < block.height; ++y)
            for (int x = 0; x < block.width; ++x)
                put(layer, layers[y * block.width + x], plane.pixel(index(block.x + x, block.y + y)));
}

std::vector<double> Film::layer_values() const {
    std::vector<double> all;
    for (const auto& [layer, plane] : planes_) all.insert(all.end(), plane.values().begin(), plane.values().end());
    return all;
}

void Film::set_layer_values(const std::vector<double>& values) {
    auto from = values.begin();
    for (auto& [layer, plane] : planes_) {
        std::copy_n(from, plane.values().size(), plane.values().begin());
        from += std::ptrdiff_t(plane.values().size());
    }
}

double Film::bytes_per_pixel(const std::vector<ImageLayer>& layers) {
    double bytes = sizeof(Pixel);
    for (const ImageLayer layer : std::set<ImageLayer>(layers.begin(), layers.end()))
        bytes += double(components(layer)) * sizeof(double);
    return bytes;
}

}  // namespace deburr
