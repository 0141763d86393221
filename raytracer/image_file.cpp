#include "raytracer/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raytracer/camera_matrix.hpp"
#include "raytracer/errors.hpp"
#include "raytracer/image_module.hpp"
#include "raytracer/whole_file.hpp"

namespace deburr {
namespace {

// The linear value whose place on the transfer curve is v.
double linear_of_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

// Where bytes begin, and, for even steps of the linear value, the byte that a step begins with. The curve
// rises by 12.92 at most, so that a step has room for the beginning of one byte more.
struct SrgbBytes {
    static constexpr int steps = 4096;
    static_assert(steps > 12.92 * 255);
    std::array<double, 257> begin{};
    std::array<unsigned char, steps> byte{};

    SrgbBytes() {
        for (int k = 1; k < 256; ++k) begin[std::size_t(k)] = linear_of_srgb((k - 0.5) / 255);
        begin[256] = infinity;
        int now = 0;
        for (int i = 0; i < steps; ++i) {
            while (begin[std::size_t(now) + 1] <= double(i) / steps) ++now;
            byte[std::size_t(i)] = static_cast<unsigned char>(now);
        }
    }

    unsigned char operator()(double linear) const {
        if (!(linear > 0)) return 0;
        if (linear >= 1) return 255;
        const unsigned char at = byte[std::size_t(linear * steps)];
        return at + (linear >= begin[std::size_t(at) + 1]);
    }
};

const SrgbBytes& srgb_bytes() {
    static const SrgbBytes bytes;
    return bytes;
}

class Channels {
public:
    explicit Channels(const Film& film) : film_(film) {}

    // value(pixel) is exact for every id: they have 32 bits.
    template <class PixelValue>
    void add(const std::string& name, ChannelType type, PixelValue value) {
        list.push_back(image_channel(name, type, [&film = film_, value](std::size_t i) { return double(value(film.pixels[i])); }));
    }

    void add_vector(const std::string& layer, const char* components, ChannelType type, Vec3 Pixel::*member) {
        for (int k = 0; k < 3; ++k) add(layer + components[k], type, [member, k](const Pixel& p) { return (p.*member)[k]; });
    }

    void add_layer(ImageLayer layer) {
        constexpr auto type = ChannelType::single_float;
        switch (layer) {
            case ImageLayer::position: return add_vector("P.", "XYZ", type, &Pixel::position);
            case ImageLayer::normal: return add_vector("N.", "XYZ", type, &Pixel::normal);
            case ImageLayer::albedo: return add_vector("Albedo.", "RGB", type, &Pixel::albedo);
            case ImageLayer::z: return add("Z", type, [](const Pixel& p) { return p.z; });
            case ImageLayer::id: return add("id", ChannelType::whole, [](const Pixel& p) { return double(p.id); });
            case ImageLayer::cost: return add("cost", type, [](const Pixel& p) { return p.cost; });
        }
    }

    std::vector<ImageChannel> list;

private:
    const Film& film_;
};

std::vector<ImageChannel> channels(const Film& film, ImageKind kind, const ImageFormat& format) {
    Channels to(film);
    if (kind == ImageKind::exr) {
        const auto color = format.float_color ? ChannelType::single_float : ChannelType::half_float;
        to.add_vector("", "RGB", color, &Pixel::color);
        to.add("A", color, [](const Pixel& p) { return p.alpha; });
        for (const ImageLayer layer : all_layers())
            if (std::count(format.layers.begin(), format.layers.end(), layer)) to.add_layer(layer);
    } else if (kind == ImageKind::linear) {
        to.add_vector("", "RGB", ChannelType::single_float, &Pixel::color);
    } else {
        for (int k = 0; k < 3; ++k)
            to.add(std::string(1, "RGB"[k]), ChannelType::byte, [k, &byte = srgb_bytes()](const Pixel& p) { return byte(p.color[k]); });
    }
    return to.list;
}

std::vector<ImageAttribute> attributes(const Film& film, const ImageNotes& notes, bool exr) {
    std::vector<ImageAttribute> all;
    all.push_back({"Software", "Deburr " DEBURR_VERSION});
    // As OpenEXR's standard attributes are named, and as the others' are.
    if (!notes.date.empty()) all.push_back({exr ? "capDate" : "DateTime", notes.date});
    if (exr) {
        all.push_back({"worldToCamera", world_to_camera(notes.camera)});
        all.push_back({"worldToNDC", world_to_ndc(notes.camera, film.width, film.height)});
        all.push_back({"utcOffset", 0.0f});
        all.push_back({"samplesPerPixel", notes.spp});
        if (notes.render_seconds) all.push_back({"renderTimeSeconds", float(*notes.render_seconds)});
    }
    for (const auto& [name, value] : notes.attributes) all.push_back({"deburr." + name, value});
    if (!film.complete) {
        if (exr) all.push_back({"deburr.incomplete", 1});
        else all.push_back({"deburr.incomplete", "1"});  // other formats keep text only
    }
    return all;
}

}  // namespace

unsigned char srgb_byte(double linear) { return srgb_bytes()(linear); }

void write_raster(const std::string& path, const ImageRaster& image, int threads, const ShareDone& done) {
    const std::string extension = image_extension(path);
    std::string bytes;
    try {
        bytes = extension == ".exr"   ? encode_exr(image, threads, done)
                : extension == ".png" ? encode_png(image, done)
                                      : image_module().encode(extension, image, done);
    } catch (const UnsupportedError&) {
        throw;
    } catch (const std::exception& error) {
        throw WorkError(fmt::format("cannot write '{}': {}", path, error.what()));
    }
    write_whole_file(path, bytes);
    if (done) done(1);
}

void write_image(const std::string& path, const Film& film, const ImageFormat& format, const ImageNotes& notes,
                 const ShareDone& done) {
    const auto kind = image_kind(path);
    if (!kind) throw WorkError(fmt::format("cannot write '{}': unknown image format", path));
    const bool exr = *kind == ImageKind::exr;
    write_raster(path, {film.width, film.height, film.window, channels(film, *kind, format), attributes(film, notes, exr)},
                 format.threads, done);
}

}  // namespace deburr
