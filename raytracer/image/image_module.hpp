// What modules (module.hpp) do for pictures: one by OpenEXR itself, which writes EXR; and one by
// OpenImageIO, which reads pictures, writes formats beside EXR and PNG, and compares as eyes do.
#pragma once
#include "raytracer/image/image_raster.hpp"
#include "raytracer/image/picture_header.hpp"

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
    /// `header` is the file's.
    virtual ReadImage read(const std::string& path, const PictureHeader& header) const = 0;
    /// Pixels of two pictures of one size in R, G, B that are visibly different [Yee 1999].
    virtual double perceptual_fails(const ReadImage& a, const ReadImage& b) const = 0;
};

/// Throws UnsupportedError if it cannot be loaded.
const ImageModule& image_module();

/// The bytes of an EXR; throws std::runtime_error.
using ExrEncoder = std::string(const ImageRaster& image, int threads, const ShareDone& done);

/// Throws UnsupportedError if it cannot be loaded.
ExrEncoder* exr_encoder();

/// Type and names of the functions that the modules export.
using ImageModuleEntry = const ImageModule*();
constexpr const char* image_module_entry = "deburr_image_module";
using ExrModuleEntry = ExrEncoder*();
constexpr const char* exr_module_entry = "deburr_exr_module";

}  // namespace deburr
