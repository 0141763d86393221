// What a picture can tell of each pixel beside its colour.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

namespace deburr {

/// In the order in which they are written.
enum class ImageLayer { position, normal, z, albedo, id, cost };

/// As --aov takes them: P, N, Z, albedo, id, cost.
std::string_view layer_name(ImageLayer layer);
std::optional<ImageLayer> find_layer(std::string_view name);
const std::vector<ImageLayer>& all_layers();

/// Numbers that it has for a pixel.
int components(ImageLayer layer);

}  // namespace deburr
