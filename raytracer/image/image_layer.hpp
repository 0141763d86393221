// What a picture can tell of each pixel beside its colour.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace deburr {

/// Layers of a picture beside colour and alpha, in the order in which they are written.
enum class ImageLayer { position, normal, z, albedo, guide_normal, id, cost, cryptomatte };

/// Names as --aov takes them: P, N, Z, albedo, normal, id, cost, crypto.
std::string_view layer_name(ImageLayer layer);
std::optional<ImageLayer> find_layer(std::string_view name);
const std::vector<ImageLayer>& all_layers();

/// Which solids a pixel's samples saw, and how many of them: the most frequent ones.
struct SolidShares {
    static constexpr int ranks = 6;
    std::array<std::uint32_t, ranks> id{};  // as in the layer id; 0: none
    std::array<double, ranks> share{};

    /// So many samples more. What no rank is left for is not counted.
    void add(std::uint32_t solid, double samples = 1) {
        for (int k = 0; k < ranks; ++k) {
            if (id[k] != solid && id[k] != 0) continue;
            id[k] = solid;
            share[k] += samples;
            return;
        }
    }
    void divide(double samples) {
        for (double& s : share) s /= samples;
    }
};

/// Numbers that it has for a pixel.
int components(ImageLayer layer);

}  // namespace deburr
