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

constexpr Extension extensions[] = {
    {".exr", ImageKind::exr},      {".png", ImageKind::display}, {".tif", ImageKind::display},
    {".tiff", ImageKind::display}, {".jpg", ImageKind::display}, {".jpeg", ImageKind::display},
    {".bmp", ImageKind::display},  {".tga", ImageKind::display}, {".ppm", ImageKind::display},
    {".webp", ImageKind::display}, {".hdr", ImageKind::linear},
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

std::string_view layer_name(Layer layer) {
    switch (layer) {
        case Layer::position:
            return "P";
        case Layer::normal:
            return "N";
        case Layer::z:
            return "Z";
        case Layer::albedo:
            return "albedo";
        case Layer::id:
            return "id";
        case Layer::cost:
            return "cost";
    }
    return {};
}

const std::vector<Layer>& all_layers() {
    static const std::vector<Layer> all = {Layer::position, Layer::normal, Layer::z,
                                           Layer::albedo,   Layer::id,     Layer::cost};
    return all;
}

std::optional<Layer> find_layer(std::string_view name) {
    for (const Layer layer : all_layers())
        if (layer_name(layer) == name) return layer;
    return std::nullopt;
}

}  // namespace deburr
