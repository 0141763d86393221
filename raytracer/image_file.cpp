#include "raytracer/image_file.hpp"

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "raytracer/camera_matrix.hpp"
#include "raytracer/errors.hpp"
#include "raytracer/whole_file.hpp"

namespace deburr {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

// Rows that are encoded at a time: a multiple of the 16 that share a ZIP block.
constexpr int rows_at_once = 64;

constexpr double largest_half = 65504;

// One channel of the file: its name, its type, and how it is got from a pixel.
struct Channel {
    std::string name;
    TypeDesc type;
    std::function<double(const Pixel&)> value;  // exact for every id: they have 32 bits
};

void add_vector(std::vector<Channel>& channels, const std::string& layer, const char* components,
                Vec3 Pixel::*member) {
    for (int k = 0; k < 3; ++k)
        channels.push_back({layer + components[k], TypeDesc::FLOAT,
                            [member, k](const Pixel& p) { return (p.*member)[k]; }});
}

void add_layer(std::vector<Channel>& channels, ImageLayer layer) {
    switch (layer) {
        case ImageLayer::position:
            return add_vector(channels, "P.", "XYZ", &Pixel::position);
        case ImageLayer::normal:
            return add_vector(channels, "N.", "XYZ", &Pixel::normal);
        case ImageLayer::albedo:
            return add_vector(channels, "Albedo.", "RGB", &Pixel::albedo);
        case ImageLayer::z:
            channels.push_back({"Z", TypeDesc::FLOAT, [](const Pixel& p) { return p.z; }});
            return;
        case ImageLayer::id:
            channels.push_back(
                {"id", TypeDesc::UINT32, [](const Pixel& p) { return double(p.id); }});
            return;
        case ImageLayer::cost:
            channels.push_back({"cost", TypeDesc::FLOAT, [](const Pixel& p) { return p.cost; }});
            return;
    }
}

std::vector<Channel> exr_channels(const ImageFormat& format) {
    const TypeDesc color = format.float_color ? TypeDesc::FLOAT : TypeDesc::HALF;
    std::vector<Channel> channels;
    for (int k = 0; k < 3; ++k)
        channels.push_back(
            {std::string(1, "RGB"[k]), color, [k](const Pixel& p) { return p.color[k]; }});
    channels.push_back({"A", color, [](const Pixel& p) { return p.alpha; }});
    for (const ImageLayer layer : all_layers())
        if (std::count(format.layers.begin(), format.layers.end(), layer))
            add_layer(channels, layer);
    return channels;
}

std::vector<Channel> rgb_channels(TypeDesc type) {
    std::vector<Channel> channels;
    for (int k = 0; k < 3; ++k)
        channels.push_back(
            {std::string(1, "RGB"[k]), type, [k](const Pixel& p) { return p.color[k]; }});
    return channels;
}

template <class T>
void append(std::vector<unsigned char>& bytes, T value) {
    const std::size_t n = bytes.size();
    bytes.resize(n + sizeof value);
    std::memcpy(bytes.data() + n, &value, sizeof value);
}

void append_value(std::vector<unsigned char>& bytes, TypeDesc type, double value) {
    if (type == TypeDesc::HALF) {
        append(bytes, Imath::half(float(std::clamp(value, -largest_half, largest_half))));
    } else if (type == TypeDesc::FLOAT) {
        append(bytes, float(value));
    } else if (type == TypeDesc::UINT32) {
        append(bytes, std::uint32_t(value));
    } else {
        append(bytes, srgb_byte(value));
    }
}

void add_notes(ImageSpec& spec, const Film& film, const ImageNotes& notes, bool exr) {
    spec.attribute("Software", "Deburr " DEBURR_VERSION);
    spec.attribute("DateTime", notes.date);
    if (exr) {
        const Matrix44 camera = world_to_camera(notes.camera);
        const Matrix44 ndc = world_to_ndc(notes.camera, film.width, film.height);
        spec.attribute("worldToCamera", OIIO::TypeMatrix44, camera.data());
        spec.attribute("worldToNDC", OIIO::TypeMatrix44, ndc.data());
        spec.attribute("utcOffset", 0.0f);
        spec.attribute("samplesPerPixel", notes.spp);
        if (notes.render_seconds) spec.attribute("renderTimeSeconds", float(*notes.render_seconds));
    }
    for (const auto& [name, value] : notes.attributes) spec.attribute("deburr." + name, value);
    if (!film.complete) {
        if (exr)
            spec.attribute("deburr.incomplete", 1);
        else
            spec.attribute("deburr.incomplete", "1");  // other formats keep text only
    }
}

ImageSpec make_spec(const Film& film, ImageKind kind, const std::vector<Channel>& channels) {
    ImageSpec spec(film.window.width, film.window.height, int(channels.size()), channels[0].type);
    if (kind == ImageKind::exr) {
        spec.x = film.window.x;
        spec.y = film.window.y;
        spec.full_x = spec.full_y = 0;
        spec.full_width = film.width;
        spec.full_height = film.height;
        spec.alpha_channel = 3;
        spec.channelnames.clear();
        for (const Channel& channel : channels) {
            spec.channelnames.push_back(channel.name);
            spec.channelformats.push_back(channel.type);
        }
        spec.attribute("compression", "zip");
    } else if (kind == ImageKind::display) {
        spec.attribute("oiio:ColorSpace", "sRGB");
        spec.attribute("CompressionQuality", 95);  // of those that lose anything
    }
    return spec;
}

}  // namespace

unsigned char srgb_byte(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    const double v =
        linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255 * v));
}

void write_image(const std::string& path, const Film& film, const ImageFormat& format,
                 const ImageNotes& notes, const std::function<void(double)>& done) {
    const auto kind = image_kind(path);
    if (!kind) throw WorkError(fmt::format("cannot write '{}': unknown image format", path));
    const std::vector<Channel> channels = *kind == ImageKind::exr ? exr_channels(format)
                                          : *kind == ImageKind::linear
                                              ? rgb_channels(TypeDesc::FLOAT)
                                              : rgb_channels(TypeDesc::UINT8);
    ImageSpec spec = make_spec(film, *kind, channels);
    add_notes(spec, film, notes, *kind == ImageKind::exr);

    // Encoded in memory: on a full disk the library's writers report success.
    OIIO::Filesystem::IOVecOutput memory;
    const auto writer = OIIO::ImageOutput::create(path);
    const auto check = [&](bool fine) {
        if (!fine) throw WorkError(fmt::format("cannot write '{}': {}", path, writer->geterror()));
    };
    check(writer->set_ioproxy(&memory));
    check(writer->open(path, spec));
    std::vector<unsigned char> bytes;
    for (int row = 0; row < film.window.height; row += rows_at_once) {
        const int end = std::min(row + rows_at_once, film.window.height);
        bytes.clear();
        for (int y = row; y < end; ++y)
            for (int x = 0; x < film.window.width; ++x) {
                const Pixel& pixel = film.at(film.window.x + x, film.window.y + y);
                for (const Channel& c : channels) append_value(bytes, c.type, c.value(pixel));
            }
        check(writer->write_scanlines(spec.y + row, spec.y + end, 0, TypeDesc::UNKNOWN,
                                      bytes.data()));
        if (done) done(double(end) / (film.window.height + 1));
    }
    check(writer->close());
    const auto& file = memory.buffer();
    write_whole_file(path, {reinterpret_cast<const char*>(file.data()), file.size()});
    if (done) done(1);
}

}  // namespace deburr
