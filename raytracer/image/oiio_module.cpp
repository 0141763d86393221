// The module behind raytracer/image/image_module.hpp: all code that calls OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <fmt/format.h>

#include <stdexcept>

#include "raytracer/image/image_module.hpp"

namespace deburr {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

struct AddAttribute {
    ImageSpec& spec;
    const std::string& name;

    void operator()(int value) const { spec.attribute(name, value); }
    void operator()(float value) const { spec.attribute(name, value); }
    void operator()(const std::string& value) const { spec.attribute(name, value); }
    void operator()(const Matrix44& value) const { spec.attribute(name, OIIO::TypeMatrix44, value.data()); }
};

OIIO::ImageBuf buffer(const ReadImage& image) {
    OIIO::ImageBuf to(ImageSpec(image.window.width, image.window.height, int(image.channels.size()), TypeDesc::FLOAT));
    to.set_pixels(OIIO::ROI(0, image.window.width, 0, image.window.height, 0, 1, 0, int(image.channels.size())),
                  TypeDesc::FLOAT, image.values.data());
    return to;
}

class Module final : public ImageModule {
public:
    // Pictures are small: thread pools are not needed, and may outlive what they use when the process ends.
    Module() {
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", -1);  // only the caller's thread
    }

    bool writes(const std::string& extension) const override {
        const auto writer = OIIO::ImageOutput::create("x" + extension);
        if (!writer) OIIO::geterror();  // clears the error, which would be printed at exit
        return writer && writer->supports("ioproxy");
    }

    std::string encode(const std::string& extension, const ImageRaster& image, const ShareDone& done) const override {
        const bool bytes = image.channels[0].type == ChannelType::byte;
        ImageSpec spec(image.window.width, image.window.height, int(image.channels.size()),
                       bytes ? TypeDesc::UINT8 : TypeDesc::FLOAT);
        if (bytes) {
            spec.attribute("oiio:ColorSpace", "sRGB");
            spec.attribute("CompressionQuality", 95);  // for lossy formats
        }
        for (const auto& [name, value] : image.attributes) std::visit(AddAttribute{spec, name}, value);
        // Encoded in memory, since on a full disk the library's writers report success.
        OIIO::Filesystem::IOVecOutput memory;
        const auto writer = OIIO::ImageOutput::create("x" + extension);
        const auto check = [&](bool fine) {
            if (!fine) throw std::runtime_error(writer ? writer->geterror() : OIIO::geterror());
        };
        check(writer && writer->set_ioproxy(&memory));
        check(writer->open("x" + extension, spec));
        std::vector<char> numbers;
        by_rows(image, done, [&](int row, int end) {
            const std::size_t width = std::size_t(image.window.width), channels = image.channels.size();
            const std::size_t first = std::size_t(row) * width, count = std::size_t(end - row) * width;
            const std::size_t size = size_of(image.channels[0].type);
            numbers.resize(count * channels * size);
            for (std::size_t c = 0; c < channels; ++c)
                image.channels[c].write(first, count, &numbers[c * size], channels * size);
            check(writer->write_scanlines(row, end, 0, spec.format, numbers.data()));
        });
        check(writer->close());
        const auto& file = memory.buffer();
        return {reinterpret_cast<const char*>(file.data()), file.size()};
    }

    ReadImage read(const std::string& path, const PictureHeader& header) const override {
        // Opened by the format's name, since otherwise all readers would be tried when the right one fails.
        const auto in = OIIO::ImageInput::create(header.format);
        if (!in) throw std::runtime_error(OIIO::geterror());
        ImageSpec spec;
        if (!in->open(path, spec)) throw std::runtime_error(in->geterror());
        if (spec.depth > 1 || spec.nchannels <= 0 || spec.deep)
            throw std::runtime_error("expected a flat picture with pixels");
        if (spec.width != header.width || spec.height != header.height)
            throw std::runtime_error(fmt::format("expected the {}x{} pixels of the file's header, got {}x{}",
                                                 header.width, header.height, spec.width, spec.height));
        ReadImage image{spec.full_width,
                        spec.full_height,
                        {spec.x - spec.full_x, spec.y - spec.full_y, spec.width, spec.height},
                        spec.channelnames,
                        {}};
        image.values.resize(std::size_t(spec.image_pixels()) * std::size_t(spec.nchannels));
        if (!in->read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, image.values.data()))
            throw std::runtime_error(in->geterror());
        // Read as floats, integers would be scaled by their type's maximum.
        for (int c = 0; c < spec.nchannels; ++c) {
            if (spec.channelformat(c) != TypeDesc::UINT32) continue;
            std::vector<std::uint32_t> whole(spec.image_pixels());
            if (!in->read_image(0, 0, c, c + 1, TypeDesc::UINT32, whole.data()))
                throw std::runtime_error(in->geterror());
            for (std::size_t i = 0; i < whole.size(); ++i)
                image.values[i * std::size_t(spec.nchannels) + std::size_t(c)] = float(whole[i]);
        }
        return image;
    }

    double perceptual_fails(const ReadImage& a, const ReadImage& b) const override {
        OIIO::ImageBufAlgo::CompareResults results;
        return OIIO::ImageBufAlgo::compare_Yee(buffer(a), buffer(b), results);
    }
};

}  // namespace
}  // namespace deburr

extern "C" __attribute__((visibility("default"))) const deburr::ImageModule* deburr_image_module() {
    static const deburr::Module module;
    return &module;
}
