#include "figures/animation.hpp"

#include <zlib.h>

#include <cassert>
#include <cmath>

#include "raytracer/image/image_file.hpp"
#include "raytracer/image/image_raster.hpp"

namespace deburr {
namespace {

std::string png_of(const Film& film) {
    ImageRaster image{film.width, film.height, film.window, {}, {}};
    for (int k = 0; k < 3; ++k)
        image.channels.push_back(image_channel(std::string(1, "RGB"[k]), ChannelType::byte, [&film, k](std::size_t i) {
            return srgb_byte(film.pixels[i].color[k]);
        }));
    return encode_png(image, {});
}

std::string number(std::uint32_t n, int bytes = 4) {
    std::string text;
    for (int k = bytes - 1; k >= 0; --k) text += char(n >> (8 * k) & 255);
    return text;
}

std::uint32_t number_at(const std::string& text, std::size_t at) {
    std::uint32_t n = 0;
    for (std::size_t k = 0; k < 4; ++k) n = n << 8 | static_cast<unsigned char>(text[at + k]);
    return n;
}

std::string chunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
    return number(std::uint32_t(data.size())) + body + number(std::uint32_t(crc));
}

struct Chunk {
    std::string type, data;
};

std::vector<Chunk> chunks_of(const std::string& png) {
    std::vector<Chunk> chunks;
    constexpr std::size_t signature = 8, frame = 12;  // bytes; a chunk's frame is length, type and checksum
    for (std::size_t at = signature; at + frame <= png.size();) {
        const std::uint32_t size = number_at(png, at);
        chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, size)});
        at += frame + size;
    }
    return chunks;
}

}  // namespace

std::string animated_png(const std::vector<Film>& frames, double seconds) {
    assert(!frames.empty());
    std::uint32_t sequence = 0;
    std::string out;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string png = png_of(frames[i]);
        const std::vector<Chunk> chunks = chunks_of(png);
        if (i == 0) {
            out = png.substr(0, 8);
            for (const Chunk& c : chunks) {
                if (c.type == "IDAT") break;
                out += chunk(c.type, c.data);
                // Number of frames, and of repetitions (0: unlimited).
                if (c.type == "IHDR") out += chunk("acTL", number(std::uint32_t(frames.size())) + number(0));
            }
        }
        const double delay = i + 1 < frames.size() ? seconds : 1;
        const auto milliseconds = std::uint32_t(std::lround(1000 * delay));
        // Size, position, delay as a fraction; the frame replaces the previous one.
        out += chunk("fcTL", number(sequence++) + number(std::uint32_t(frames[i].window.width)) +
                                 number(std::uint32_t(frames[i].window.height)) + number(0) + number(0) +
                                 number(milliseconds, 2) + number(1000, 2) + number(0, 1) + number(0, 1));
        for (const Chunk& c : chunks) {
            if (c.type != "IDAT") continue;
            out += i == 0 ? chunk("IDAT", c.data) : chunk("fdAT", number(sequence++) + c.data);
        }
    }
    return out + chunk("IEND", "");
}

}  // namespace deburr
