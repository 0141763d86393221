// A picture for encoders, whatever it shows: named channels of numbers, and attributes.
//
// A channel writes its numbers itself, in the file's type and where the encoder wants them: so there is no intermediate
// copy, and one call for many pixels.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "raytracer/image/camera_matrix.hpp"
#include "raytracer/image/film.hpp"

namespace deburr {

/// The number type of a channel, and the values that it takes.
enum class ChannelType {
    byte,        // 8 bit; the value is 0 … 255
    word,        // 16 bit; the value is 0 … 65535
    half_float,  // values beyond the largest half become that
    single_float,
    whole,  // 32 bits, unsigned
};

constexpr std::size_t size_of(ChannelType type) {
    return type == ChannelType::byte ? 1 : type == ChannelType::half_float || type == ChannelType::word ? 2 : 4;
}

/// The bits of the value as a finite 16-bit float.
std::uint16_t half_bits(double value);

/// A channel of a picture.
struct ImageChannel {
    std::string name;
    ChannelType type;
    /// Writes `count` numbers for the window's pixels (row by row) from pixel `first` on to `to`, `stride` bytes apart.
    std::function<void(std::size_t first, std::size_t count, char* to, std::size_t stride)> write;
};

/// A channel whose value at pixel i is value(i).
template <class Value>
ImageChannel image_channel(std::string name, ChannelType type, Value value) {
    const auto write_as = [value](auto number_of) {
        return [value, number_of](std::size_t first, std::size_t count, char* to, std::size_t stride) {
            const Value local = value;  // a copy, which stores through `to` cannot change
            for (std::size_t i = 0; i < count; ++i, to += stride) {
                const auto number = number_of(local(first + i));
                std::memcpy(to, &number, sizeof number);
            }
        };
    };
    switch (type) {
        case ChannelType::byte:
            return {std::move(name), type, write_as([](auto v) { return static_cast<unsigned char>(v); })};
        case ChannelType::word:
            return {std::move(name), type, write_as([](auto v) { return static_cast<std::uint16_t>(v); })};
        case ChannelType::half_float: return {std::move(name), type, write_as([](auto v) { return half_bits(v); })};
        case ChannelType::single_float: return {std::move(name), type, write_as([](auto v) { return float(v); })};
        case ChannelType::whole: return {std::move(name), type, write_as([](auto v) { return std::uint32_t(v); })};
    }
    return {};
}

using ImageAttribute = std::pair<std::string, std::variant<int, float, std::string, Matrix44>>;

/// A picture to be encoded.
struct ImageRaster {
    int width = 0, height = 0;           // of the whole picture
    Window window;                       // the part that is stored
    std::vector<ImageChannel> channels;  // all of one type for PNG and other files for the screen
    std::vector<ImageAttribute> attributes;
};

/// A callback for the share that is done, from 0 to 1.
using ShareDone = std::function<void(double)>;

/// The number of rows encoded at a time: a multiple of the 16 rows in a ZIP block of an EXR.
constexpr int rows_at_once = 64;

/// Calls rows(first, end) for all rows of the window, rows_at_once at a time, and reports progress.
template <class Rows>
void by_rows(const ImageRaster& image, const ShareDone& done, Rows rows) {
    const int height = image.window.height;
    for (int row = 0; row < height; row += rows_at_once) {
        const int end = std::min(row + rows_at_once, height);
        rows(row, end);
        if (done) done(double(end) / (height + 1));
    }
}

/// The bytes of a PNG; throws std::runtime_error. Channels are R, G, B and optionally A, all bytes or all words, in
/// sRGB and not premultiplied by alpha [PNG §6.2]. Attributes become text chunks.
std::string encode_png(const ImageRaster& image, const ShareDone& done);

}  // namespace deburr
