// Which files a picture can be written to.
#pragma once
#include <optional>
#include <string>

namespace deburr {

/// How a format holds colour.
enum class ImageKind {
    exr,      // scene-linear, alpha, layers, attributes
    linear,   // scene-linear RGB in floating point
    display,  // 8 bit sRGB RGB
};

/// Extension of the file's name, with its dot, in small letters.
std::string image_extension(const std::string& path);

/// Kind of image that the extension stands for; none if it is unknown or OpenImageIO here cannot write it. Throws
/// UnsupportedError if a module is needed for it and cannot be loaded.
std::optional<ImageKind> image_kind(const std::string& path);

/// All extensions that image_kind() knows, for messages: ".exr, .png, …".
std::string known_extensions();

}  // namespace deburr
