// Which files a picture can be written to, and which layers an EXR can hold.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deburr {

/// How a format holds colour.
enum class ImageKind {
    exr,      // scene-linear, alpha, layers, attributes
    linear,   // scene-linear RGB in floating point
    display,  // 8 bit sRGB RGB
};

/// Of the file's name, with its dot, in small letters.
std::string image_extension(const std::string& path);

/// By the extension; nothing if it is unknown or this machine's OpenImageIO cannot write it. Throws
/// UnsupportedError if OpenImageIO is needed and cannot be loaded.
std::optional<ImageKind> image_kind(const std::string& path);

/// All extensions that image_kind() knows, for messages: ".exr, .png, …".
std::string known_extensions();

/// In the order in which they are written.
enum class ImageLayer { position, normal, z, albedo, id, cost };

/// As --aov takes them: P, N, Z, albedo, id, cost.
std::string_view layer_name(ImageLayer layer);
std::optional<ImageLayer> find_layer(std::string_view name);
const std::vector<ImageLayer>& all_layers();

}  // namespace deburr
