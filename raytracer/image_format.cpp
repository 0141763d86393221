#include "raytracer/image_format.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace deburr {
namespace {

struct Extension {
    std::string_view name;
    ImageKind kind;
};

// Not TIFF: OpenImageIO 2.4.7 encodes in memory a file that it cannot read again.
constexpr Extension extensions[] = {
    {".exr", ImageKind::exr},      {".png", ImageKind::display},  {".jpg", ImageKind::display},
    {".jpeg", ImageKind::display}, {".bmp", ImageKind::display},  {".tga", ImageKind::display},
    {".ppm", ImageKind::display},  {".webp", ImageKind::display}, {".hdr", ImageKind::linear},
};

}  // namespace

std::optional<ImageKind> image_kind(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    for (const Extension& known : extensions) {
        if (known.name != extension) continue;
        // Only what can be encoded in memory can be written whole or not at all.
        const auto writer = OIIO::ImageOutput::create("x" + extension);
        if (writer && writer->supports("ioproxy")) return known.kind;
        if (!writer) OIIO::geterror();  // or it is printed at exit
    }
    return std::nullopt;
}

std::string known_extensions() {
    std::string all;
    for (const Extension& known : extensions) {
        if (!all.empty()) all += ", ";
        all += known.name;
    }
    return all;
}

std::string_view layer_name(ImageLayer layer) {
    switch (layer) {
        case ImageLayer::position:
            return "P";
        case ImageLayer::normal:
            return "N";
        case ImageLayer::z:
            return "Z";
        case ImageLayer::albedo:
            return "albedo";
        case ImageLayer::id:
            return "id";
        case ImageLayer::cost:
            return "cost";
    }
    return {};
}

const std::vector<ImageLayer>& all_layers() {
    static const std::vector<ImageLayer> all = {ImageLayer::position, ImageLayer::normal,
                                                ImageLayer::z,        ImageLayer::albedo,
                                                ImageLayer::id,       ImageLayer::cost};
    return all;
}

std::optional<ImageLayer> find_layer(std::string_view name) {
    for (const ImageLayer layer : all_layers())
        if (layer_name(layer) == name) return layer;
    return std::nullopt;
}

}  // namespace deburr
