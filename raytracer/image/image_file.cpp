#include "raytracer/image/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "raytracer/image/camera_matrix.hpp"
#include "raytracer/image/cryptomatte.hpp"
#include "raytracer/image/image_module.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {

double linear_of_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

namespace {

// A table for srgb_byte(): the least linear value of each byte and, for even steps of the linear value, the byte at the
// step's beginning. The curve's slope is at most 12.92, so that at most one more byte begins within a step.
struct SrgbBytes {
    static constexpr int steps = 4096;
    static_assert(steps > 12.92 * 255);
    std::array<double, 257> begin{};
    std::array<unsigned char, steps> byte{};

    SrgbBytes() {
        for (int k = 1; k < 256; ++k) begin[k] = linear_of_srgb((k - 0.5) / 255);
        begin[256] = infinity;
        int now = 0;
        for (int i = 0; i < steps; ++i) {
            while (begin[std::size_t(now) + 1] <= double(i) / steps) ++now;
            byte[i] = static_cast<unsigned char>(now);
        }
    }

    unsigned char operator()(double linear) const {
        if (!(linear > 0)) return 0;
        if (linear >= 1) return 255;
        const unsigned char at = byte[int(linear * steps)];
        return at + (linear >= begin[std::size_t(at) + 1]);
    }
};

const SrgbBytes& srgb_bytes() {
    static const SrgbBytes bytes;
    return bytes;
}

struct LayerChannels {
    ImageLayer layer;
    std::vector<const char*> names;
    ChannelType type = ChannelType::single_float;
};

const LayerChannels layer_channels[] = {
    {ImageLayer::position, {"P.X", "P.Y", "P.Z"}},
    {ImageLayer::normal, {"N.X", "N.Y", "N.Z"}},
    {ImageLayer::z, {"Z"}},
    {ImageLayer::albedo, {"Albedo.R", "Albedo.G", "Albedo.B"}},
    {ImageLayer::guide_normal, {"Normal.X", "Normal.Y", "Normal.Z"}},
    {ImageLayer::id, {"id"}, ChannelType::whole},
    {ImageLayer::cost, {"cost"}},
};

// The channels R, G, B and, if wanted, A of a PNG. Colours premultiplied by alpha are divided by it.
template <class Number>
std::vector<ImageChannel> png_channels(const Film& film, ChannelType type, const ImageFormat& format, Number srgb) {
    std::vector<ImageChannel> list;
    const Pixel* pixels = film.pixels.data();
    const bool alpha = format.alpha;
    const double scale = std::exp2(format.exposure);
    for (int k = 0; k < 3; ++k)
        list.push_back(image_channel(std::string(1, "RGB"[k]), type, [pixels, k, alpha, scale, srgb](std::size_t i) {
            const double value = scale * glm::value_ptr(pixels[i].color)[k];
            if (!alpha) return srgb(value);
            return srgb(pixels[i].alpha > 0 ? value / pixels[i].alpha : 0.0);
        }));
    const double most = type == ChannelType::byte ? 255 : 65535;
    if (alpha)
        list.push_back(image_channel("A", type, [pixels, most](std::size_t i) {
            return std::round(most * std::clamp(pixels[i].alpha, 0.0, 1.0));
        }));
    return list;
}

std::vector<ImageChannel> channels(const Film& film, ImageKind kind, const ImageFormat& format,
                                   const ImageNotes& notes) {
    std::vector<ImageChannel> list;
    const Pixel* pixels = film.pixels.data();
    const auto add_color = [&](ChannelType type, auto value_of) {
        for (int k = 0; k < 3; ++k)
            list.push_back(image_channel(std::string(1, "RGB"[k]), type, [pixels, k, value_of](std::size_t i) {
                return value_of(glm::value_ptr(pixels[i].color)[k]);
            }));
    };
    const auto as_it_is = [](double value) { return value; };
    if (kind == ImageKind::display) {
        const double scale = std::exp2(format.exposure);
        add_color(ChannelType::byte, [&byte = srgb_bytes(), scale](double value) { return byte(scale * value); });
        return list;
    }
    if (kind == ImageKind::linear) {
        add_color(ChannelType::single_float, as_it_is);
        return list;
    }
    const auto color = format.float_color ? ChannelType::single_float : ChannelType::half_float;
    add_color(color, as_it_is);
    list.push_back(image_channel("A", color, [pixels](std::size_t i) { return pixels[i].alpha; }));
    for (const auto& [layer, names, type] : layer_channels) {
        if (!film.keeps(layer)) continue;
        for (int k = 0; k < components(layer); ++k)
            list.push_back(image_channel(names[k], type,
                                         [&plane = film.layer(layer), k](std::size_t i) { return plane.at(i, k); }));
    }
    if (film.keeps(ImageLayer::cryptomatte)) {
        std::vector<double> hashes = {0};  // by id; 0: nothing
        for (const std::string& name : notes.solids) hashes.push_back(cryptomatte_number(name));
        for (int k = 0; k < 2 * SolidShares::ranks; ++k)
            list.push_back(image_channel(fmt::format("{}{:02}.{}", cryptomatte_layer, k / 4, "RGBA"[k % 4]),
                                         ChannelType::single_float,
                                         [&plane = film.layer(ImageLayer::cryptomatte), k, hashes](std::size_t i) {
                                             const double value = plane.at(i, k);
                                             if (k % 2 == 1) return value;
                                             return value < double(hashes.size()) ? hashes[std::size_t(value)] : 0.0;
                                         }));
    }
    return list;
}

std::vector<ImageAttribute> attributes(const Film& film, const ImageNotes& notes, bool exr) {
    std::vector<ImageAttribute> all;
    all.push_back({"Software", "Deburr " DEBURR_VERSION});
    // Named as in OpenEXR's standard attributes, or as OpenImageIO names them for other formats.
    if (!notes.date.empty()) all.push_back({exr ? "capDate" : "DateTime", notes.date});
    if (exr) {
        all.push_back({"worldToCamera", world_to_camera(notes.camera)});
        all.push_back({"worldToNDC", world_to_ndc(notes.camera, film.width, film.height)});
        all.push_back({"utcOffset", 0.0f});
        all.push_back({"samplesPerPixel", notes.spp});
        if (notes.render_seconds) all.push_back({"renderTimeSeconds", float(*notes.render_seconds)});
    }
    for (const auto& [name, value] : notes.attributes) all.push_back({"deburr." + name, value});
    if (exr && film.keeps(ImageLayer::cryptomatte))
        for (const auto& [name, value] : cryptomatte_attributes(notes.solids)) all.push_back({name, value});
    if (!film.complete) {
        if (exr)
            all.push_back({"deburr.incomplete", 1});
        else
            all.push_back({"deburr.incomplete", "1"});  // other formats store text only
    }
    return all;
}

}  // namespace

unsigned char srgb_byte(double linear) { return srgb_bytes()(linear); }

std::uint16_t srgb_word(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 65535;
    const double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<std::uint16_t>(std::lround(65535 * v));
}

void write_raster(const std::string& path, const ImageRaster& image, int threads, const ShareDone& done) {
    const std::string extension = image_extension(path);
    std::string bytes;
    try {
        bytes = extension == ".exr"   ? exr_encoder()(image, threads, done)
                : extension == ".png" ? encode_png(image, done)
                                      : image_module().encode(extension, image, done);
    } catch (const UnsupportedError&) {
        throw;
    } catch (const std::bad_alloc&) {
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
    const bool exr = *kind == ImageKind::exr, png = image_extension(path) == ".png";
    if (*kind == ImageKind::display && format.view != ViewTransform::standard) {
        ImageFormat as_it_is = format;
        as_it_is.view = ViewTransform::standard;
        as_it_is.exposure = 0;
        Film exposed = film;
        for (Pixel& pixel : exposed.pixels) pixel.color *= std::exp2(format.exposure);
        return write_image(path, displayed(format.view, std::move(exposed), format.alpha), as_it_is, notes, done);
    }
    std::vector<ImageChannel> list;
    if (png && format.bits == 16)
        list = png_channels(film, ChannelType::word, format, srgb_word);
    else if (png && format.alpha)
        list = png_channels(film, ChannelType::byte, format, srgb_byte);
    else
        list = channels(film, *kind, format, notes);
    write_raster(path, {film.width, film.height, film.window, std::move(list), attributes(film, notes, exr)},
                 format.threads, done);
}

}  // namespace deburr
