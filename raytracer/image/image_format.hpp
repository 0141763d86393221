// Which file formats a picture can be written in.
#pragma once
#include <optional>
#include <string>

namespace deburr {

/// The kind of colour that a format stores.
enum class ImageKind {
    exr,      // scene-linear, alpha, layers, attributes
    linear,   // scene-linear RGB in floating point
    display,  // 8 bit sRGB RGB
};

/// The extension of a file name, with its dot, in lower case.
std::string image_extension(const std::string& path);

/// The kind of image for the file name's extension; none if it is unknown or this OpenImageIO cannot write it. Throws
/// UnsupportedError if the format needs a module that cannot be loaded.
std::optional<ImageKind> image_kind(const std::string& path);

/// All extensions that image_kind() knows, as a list for messages: ".exr, .png, …".
std::string known_extensions();

}  // namespace deburr
