#include "raytracer/image/image_format.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "raytracer/image/image_module.hpp"

namespace deburr {
namespace {

struct Extension {
    std::string_view name;
    ImageKind kind;
};

// TIFF is missing: OpenImageIO 2.4.7 encodes in memory a TIFF that it cannot read again.
constexpr Extension extensions[] = {
    {".exr", ImageKind::exr},      {".png", ImageKind::display},  {".jpg", ImageKind::display},
    {".jpeg", ImageKind::display}, {".bmp", ImageKind::display},  {".tga", ImageKind::display},
    {".ppm", ImageKind::display},  {".webp", ImageKind::display}, {".hdr", ImageKind::linear},
};

}  // namespace

std::string image_extension(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::optional<ImageKind> image_kind(const std::string& path) {
    const std::string extension = image_extension(path);
    for (const Extension& known : extensions) {
        if (known.name != extension) continue;
        if (extension == ".exr")
            exr_encoder();  // loaded now, or its absence would be noticed after the rendering
        else if (extension != ".png" && !image_module().writes(extension))
            return std::nullopt;
        return known.kind;
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

}  // namespace deburr
