// What only OpenImageIO does: reading pictures, formats beside EXR and PNG, comparing as eyes do.
//
// Debian's OpenImageIO depends on 250 shared libraries, and loading them takes longer than most
// pictures. So the code that calls it is a module of its own, beside the program, that is loaded when
// it is first asked for.
#pragma once
#include "raytracer/image_raster.hpp"

namespace deburr {

/// A picture that was read.
struct ReadImage {
    int width = 0, height = 0;
    Window window;
    std::vector<std::string> channels;
    std::vector<float> values;  // by pixel, then channel; whole numbers as they are, bytes from 0 to 1
};

/// Its functions throw std::runtime_error.
class ImageModule {
public:
    virtual ~ImageModule() = default;
    /// ".jpg"; only what can be encoded in memory can be written whole or not at all.
    virtual bool writes(const std::string& extension) const = 0;
    virtual std::string encode(const std::string& extension, const ImageRaster& image, const ShareDone& done) const = 0;
    virtual ReadImage read(const std::string& path) const = 0;
    /// Pixels of two pictures of one size in R, G, B that are visibly different [Yee 1999].
    virtual double perceptual_fails(const ReadImage& a, const ReadImage& b) const = 0;
};

/// Throws UnsupportedError if it cannot be loaded.
const ImageModule& image_module();

/// What the module gives, by this name.
using ImageModuleEntry = const ImageModule*();
constexpr const char* image_module_entry = "deburr_image_module";

}  // namespace deburr
