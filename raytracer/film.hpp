// The picture in memory: what every pixel of a window saw, before any file format.
#pragma once
#include <cstdint>
#include <vector>

#include "bounds/vec.hpp"
#include "raytracer/large_pages.hpp"

namespace deburr {

/// A rectangle of pixels; (0, 0) is the top left one of the whole picture.
struct Window {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(const Window&) const = default;
};

/// Colour is scene-linear Rec. 709, averaged over the samples; it contains the background, while
/// alpha is the share of samples that hit something. The layers below it are those of one ray
/// through the pixel's centre, so that two renderers can be compared ray by ray.
struct Pixel {
    Vec3 color{0.0};
    double alpha = 0.0;
    Vec3 position{0.0};  // world, of the first hit
    Vec3 normal{0.0};    // unit, out of the solid
    double z = infinity; // distance along the camera's axis
    Vec3 albedo{0.0};
    std::uint32_t id = 0;  // 1 + index of the solid; 0: nothing was hit
    double cost = 0.0;     // density evaluations, all samples
};

struct Film {
    int width = 0, height = 0;  // the whole picture (display window)
    Window window;              // the part that is held (data window)
    bool complete = true;       // false: interrupted, some pixels are still empty
    std::vector<Pixel, LargePages<Pixel>> pixels;  // window.width * window.height, row by row

    Film() = default;
    Film(int width, int height, Window window)
        : width(width), height(height), window(window),
          pixels(std::size_t(window.width) * std::size_t(window.height)) {}

    /// x, y in the whole picture, within the window.
    Pixel& at(int x, int y) {
        return pixels[std::size_t(y - window.y) * std::size_t(window.width) + std::size_t(x - window.x)];
    }
    const Pixel& at(int x, int y) const { return const_cast<Film*>(this)->at(x, y); }
};

}  // namespace deburr
