#include "raytracer/image/image_layer.hpp"

#include <array>

namespace deburr {
namespace {

struct Known {
    ImageLayer layer;
    std::string_view name;
    int components;
};

constexpr std::array<Known, 8> known = {{{ImageLayer::position, "P", 3},
                                         {ImageLayer::normal, "N", 3},
                                         {ImageLayer::z, "Z", 1},
                                         {ImageLayer::albedo, "albedo", 3},
                                         {ImageLayer::guide_normal, "normal", 3},
                                         {ImageLayer::id, "id", 1},
                                         {ImageLayer::cost, "cost", 1},
                                         {ImageLayer::cryptomatte, "crypto", 2 * SolidShares::ranks}}};

const Known& of(ImageLayer layer) { return known[std::size_t(layer)]; }

}  // namespace

std::string_view layer_name(ImageLayer layer) { return of(layer).name; }

int components(ImageLayer layer) { return of(layer).components; }

const std::vector<ImageLayer>& all_layers() {
    static const std::vector<ImageLayer> all = [] {
        std::vector<ImageLayer> layers;
        for (const Known& k : known) layers.push_back(k.layer);
        return layers;
    }();
    return all;
}

std::optional<ImageLayer> find_layer(std::string_view name) {
    for (const Known& k : known)
        if (k.name == name) return k.layer;
    return std::nullopt;
}

}  // namespace deburr
