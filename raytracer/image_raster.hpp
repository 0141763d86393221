// A picture as encoders take it, whatever it shows: named channels of numbers, and attributes.
#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "raytracer/camera_matrix.hpp"
#include "raytracer/film.hpp"

namespace deburr {

enum class ChannelType {
    byte,        // 8 bit; the value is 0 … 255
    half_float,  // of what is brighter, the largest finite one
    single_float,
    whole,       // 32 bit, unsigned
};

struct ImageChannel {
    std::string name;
    ChannelType type;
    /// The values of `count` pixels from `first` on, of the window's, row by row.
    std::function<void(std::size_t first, std::size_t count, double* to)> values;
};

/// Whose value at pixel i is value(i).
template <class Value>
ImageChannel image_channel(std::string name, ChannelType type, Value value) {
    return {std::move(name), type, [value](std::size_t first, std::size_t count, double* to) {
                for (std::size_t i = 0; i < count; ++i) to[i] = value(first + i);
            }};
}

using ImageAttribute = std::pair<std::string, std::variant<int, float, std::string, Matrix44>>;

struct ImageRaster {
    int width = 0, height = 0;  // the whole picture
    Window window;              // the part that is there
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

/// The bytes of a file. They throw std::runtime_error.
std::string encode_exr(const ImageRaster& image, int threads, const ShareDone& done);
/// R, G, B as bytes: sRGB. Attributes become text.
std::string encode_png(const ImageRaster& image, const ShareDone& done);

}  // namespace deburr
