// The picture in memory: what every pixel of a window saw, before any file format.
//
// Colour and alpha are always kept, in 32 bytes a pixel; layers are kept on request, since together
// they need three times as much again.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "bounds/vec.hpp"
#include "raytracer/image/image_layer.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

/// Width and height of a picture in pixels.
struct Size {
    int width = 0, height = 0;

    bool operator==(const Size&) const = default;
};

/// A rectangle of pixels; (0, 0) is the top left one of the whole picture.
struct Window {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(const Window&) const = default;
};

/// Colour is scene-linear Rec. 709, averaged over the samples; it contains the background, while
/// alpha is the share of samples that hit something.
struct Pixel {
    Vec3 color{0.0};
    double alpha = 0.0;
};

/// Layers of a pixel: of the ray through its centre, so that two renderers can be compared ray by ray;
/// but albedo, guide_normal and cost are of all samples.
struct PixelLayers {
    Vec3 position{0.0};   // world, of the first hit
    Vec3 normal{0.0};     // unit, out of the solid
    double z = infinity;  // distance along the camera's axis
    // Averaged, for denoisers: of the first surface that is neither a mirror nor polished glass, as bright as those
    // show it; the normal is the one that it is shaded with, on the eye's side.
    Vec3 albedo{0.0}, guide_normal{0.0};
    std::uint32_t id = 0;  // 1 + index of the solid; 0: nothing was hit
    double cost = 0.0;     // density evaluations
    SolidShares solids;    // of all samples
};

/// One layer of a film; i counts the window's pixels, row by row.
class LayerPlane {
public:
    LayerPlane(ImageLayer layer, std::size_t pixels)
        : components_(std::size_t(components(layer))), values_(pixels * components_) {}

    double at(std::size_t i, int component = 0) const { return values_[i * components_ + std::size_t(component)]; }
    /// Value at pixel i of a layer with three components.
    Vec3 vec(std::size_t i) const { return {at(i, 0), at(i, 1), at(i, 2)}; }
    double* pixel(std::size_t i) { return &values_[i * components_]; }
    auto& values() { return values_; }
    const auto& values() const { return values_; }

private:
    std::size_t components_;
    LargeVector<double> values_;
};

struct Film {
    int width = 0, height = 0;  // the whole picture (display window)
    Window window;              // the part that is held (data window)
    bool complete = true;       // false: interrupted, some pixels are still empty
    LargeVector<Pixel> pixels;  // window.width * window.height, row by row

    Film() = default;
    /// All pixels are empty.
    Film(int width, int height, Window window, const std::vector<ImageLayer>& layers = {});

    /// x, y in the whole picture, within the window.
    Pixel& at(int x, int y) { return pixels[index(x, y)]; }
    const Pixel& at(int x, int y) const { return pixels[index(x, y)]; }
    std::size_t index(int x, int y) const {
        return std::size_t(y - window.y) * std::size_t(window.width) + std::size_t(x - window.x);
    }

    bool keeps_layers() const { return !planes_.empty(); }
    bool keeps(ImageLayer layer) const { return planes_.count(layer) > 0; }
    /// Throws std::logic_error if it is not kept.
    const LayerPlane& layer(ImageLayer layer) const;
    /// Sets the layers of a block within the window, row by row; layers that the film does not keep are dropped.
    void set_layers(const Window& block, const PixelLayers* layers);

    /// The numbers of all layers, one layer after the other; and back, of a film that keeps the same.
    std::vector<double> layer_values() const;
    void set_layer_values(const std::vector<double>& values);

    static double bytes_per_pixel(const std::vector<ImageLayer>& layers);

private:
    std::map<ImageLayer, LayerPlane> planes_;
};

}  // namespace deburr
