// A picture as encoders take it, whatever it shows: named channels of numbers, and attributes.
//
// A channel writes its numbers itself, as the file has them and where the encoder wants them: there
// are no values between, and one call for many pixels.
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

enum class ChannelType {
    byte,        // 8 bit; the value is 0 … 255
    word,        // 16 bit; the value is 0 … 65535
    half_float,  // of what is brighter, the largest finite one
    single_float,
    whole,  // 32 bit, unsigned
};

constexpr std::size_t size_of(ChannelType type) {
    return type == ChannelType::byte ? 1 : type == ChannelType::half_float || type == ChannelType::word ? 2 : 4;
}

/// The bits of a number of 16 bits, finite.
std::uint16_t half_bits(double value);

struct ImageChannel {
    std::string name;
    ChannelType type;
    /// Writes `count` numbers, of the window's pixels from `first` on, row by row; the next is
    /// `stride` bytes on.
    std::function<void(std::size_t first, std::size_t count, char* to, std::size_t stride)> write;
};

/// A channel whose value at pixel i is value(i).
template <class Value>
ImageChannel image_channel(std::string name, ChannelType type, Value value) {
    const auto write_as = [value](auto number_of) {
        return [value, number_of](std::size_t first, std::size_t count, char* to, std::size_t stride) {
            const Value local = value;  // a char* may point at the other
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

struct ImageRaster {
    int width = 0, height = 0;           // the whole picture
    Window window;                       // the part that is there
    std::vector<ImageChannel> channels;  // of one type each, for PNG and what is for the screen
    std::vector<ImageAttribute> attributes;
};

/// Told the share that is done, from 0 to 1.
using ShareDone = std::function<void(double)>;

/// Rows that are encoded at a time: a multiple of the 16 that share a ZIP block of an EXR.
constexpr int rows_at_once = 64;

/// Calls rows(first, end) for all rows of the window, 64 at a time, and tells how far it is.
template <class Rows>
void by_rows(const ImageRaster& image, const ShareDone& done, Rows rows) {
    const int height = image.window.height;
    for (int row = 0; row < height; row += rows_at_once) {
        const int end = std::min(row + rows_at_once, height);
        rows(row, end);
        if (done) done(double(end) / (height + 1));
    }
}

/// The bytes of a file; throws std::runtime_error. R, G, B, and A if there is one, all as bytes or all as words:
/// sRGB, not multiplied by alpha [PNG §6.2]. Attributes become text.
std::string encode_png(const ImageRaster& image, const ShareDone& done);

}  // namespace deburr
