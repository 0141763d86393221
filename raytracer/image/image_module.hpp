// The interfaces of two modules (util/module.hpp) for pictures: one by OpenEXR, which writes EXR, and one by
// OpenImageIO, which reads pictures, writes formats other than EXR and PNG, and compares pictures perceptually.
#pragma once
#include "raytracer/image/image_raster.hpp"
#include "raytracer/image/picture_header.hpp"

namespace deburr {

/// A picture as it was read.
struct ReadImage {
    int width = 0, height = 0;
    Window window;
    std::vector<std::string> channels;
    std::vector<float> values;  // by pixel, then channel; integers as they are, bytes scaled to 0 … 1
};

/// The functions of OpenImageIO's module; all throw std::runtime_error.
class ImageModule {
public:
    virtual ~ImageModule() = default;
    /// Whether files with this extension (".jpg") can be written; they must be encoded in memory, to be written whole
    /// or not at all.
    virtual bool writes(const std::string& extension) const = 0;
    /// The bytes of a file with this extension.
    virtual std::string encode(const std::string& extension, const ImageRaster& image, const ShareDone& done) const = 0;
    /// Reads a picture; `header` is what read_picture_header() returned for the file.
    virtual ReadImage read(const std::string& path, const PictureHeader& header) const = 0;
    /// The number of pixels that are visibly different [Yee 1999] between two pictures of one size with channels R, G
    /// and B.
    virtual double perceptual_fails(const ReadImage& a, const ReadImage& b) const = 0;
};

/// The module, loaded on first use. Throws UnsupportedError if that fails.
const ImageModule& image_module();

/// The type of the function that encodes an EXR; throws std::runtime_error.
using ExrEncoder = std::string(const ImageRaster& image, int threads, const ShareDone& done);

/// The EXR encoder, loaded on first use. Throws UnsupportedError if that fails.
ExrEncoder* exr_encoder();

/// Types and names of the functions that the modules export.
using ImageModuleEntry = const ImageModule*();
constexpr const char* image_module_entry = "deburr_image_module";
using ExrModuleEntry = ExrEncoder*();
constexpr const char* exr_module_entry = "deburr_exr_module";

}  // namespace deburr
