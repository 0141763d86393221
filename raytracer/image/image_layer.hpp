// The layers (AOVs) that a picture can have besides colour and alpha.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace deburr {

/// The layers, in the order in which they are written.
enum class ImageLayer { position, normal, z, albedo, guide_normal, id, cost, cryptomatte };

/// The name of a layer for --aov: P, N, Z, albedo, normal, id, cost, crypto.
std::string_view layer_name(ImageLayer layer);
/// The layer with this name, if there is one.
std::optional<ImageLayer> find_layer(std::string_view name);
const std::vector<ImageLayer>& all_layers();

/// The solids that a pixel's samples hit, with the number or share of samples of each.
struct SolidShares {
    static constexpr int ranks = 6;
    std::array<std::uint32_t, ranks> id{};  // as in the layer id; 0: none
    std::array<double, ranks> share{};

    /// Counts samples of a solid. Solids beyond the first `ranks` are not counted.
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

/// The number of values that a layer has for a pixel.
int components(ImageLayer layer);

}  // namespace deburr
