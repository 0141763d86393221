// The film: the picture in memory, with the values of every pixel of a window, before any file format.
//
// Colour and alpha are always kept, in 32 bytes a pixel; layers are kept on request, since together they need three
// times as much again.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "bounds/vec.hpp"
#include "raytracer/image/image_layer.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

/// The width and height of a picture in pixels.
struct Size {
    int width = 0, height = 0;

    bool operator==(const Size&) const = default;
};

/// A rectangle of pixels; (0, 0) is the upper left pixel of the whole picture.
struct Window {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(const Window&) const = default;
};

/// A pixel's colour in scene-linear Rec. 709, averaged over its samples and including the background, and its alpha,
/// the share of samples that hit a solid.
struct Pixel {
    Vec3 color{0.0};
    double alpha = 0.0;
};

/// The layers of a pixel. Most are those of the ray through its center, so that two renderers can be compared ray by
/// ray; albedo, guide_normal, cost and solids are of all samples.
struct PixelLayers {
    Vec3 position{0.0};   // of the first hit, in world coordinates
    Vec3 normal{0.0};     // unit, out of the solid
    double z = infinity;  // distance along the camera's axis
    // Averages for denoisers, of the first surface that is neither a mirror nor polished glass, dimmed as those dim it.
    // The normal is the shading normal, on the eye's side.
    Vec3 albedo{0.0}, guide_normal{0.0};
    std::uint32_t id = 0;  // 1 + index of the solid; 0: nothing was hit
    double cost = 0.0;     // number of density evaluations
    SolidShares solids;    // over all samples
};

/// The values of one layer; pixel i counts the window's pixels row by row.
class LayerPlane {
public:
    LayerPlane(ImageLayer layer, std::size_t pixels)
        : components_(std::size_t(components(layer))), values_(pixels * components_) {}

    double at(std::size_t i, int component = 0) const { return values_[i * components_ + std::size_t(component)]; }
    /// The value at pixel i of a layer with three components.
    Vec3 vec(std::size_t i) const { return {at(i, 0), at(i, 1), at(i, 2)}; }
    double* pixel(std::size_t i) { return &values_[i * components_]; }
    auto& values() { return values_; }
    const auto& values() const { return values_; }

private:
    std::size_t components_;
    LargeVector<double> values_;
};

/// A picture, or the part of it within a window.
struct Film {
    int width = 0, height = 0;  // of the whole picture (display window)
    Window window;              // the part that is held (data window)
    bool complete = true;       // false if rendering was interrupted and some pixels are empty
    LargeVector<Pixel> pixels;  // row by row

    Film() = default;
    /// A film with empty pixels and these layers.
    Film(int width, int height, Window window, const std::vector<ImageLayer>& layers = {});

    /// The pixel at (x, y) of the whole picture, which must be within the window.
    Pixel& at(int x, int y) { return pixels[index(x, y)]; }
    const Pixel& at(int x, int y) const { return pixels[index(x, y)]; }
    std::size_t index(int x, int y) const {
        return std::size_t(y - window.y) * std::size_t(window.width) + std::size_t(x - window.x);
    }

    bool keeps_layers() const { return !planes_.empty(); }
    bool keeps(ImageLayer layer) const { return planes_.count(layer) > 0; }
    /// The values of a layer. Throws std::logic_error if the film does not keep it.
    const LayerPlane& layer(ImageLayer layer) const;
    /// Sets the layers of a block within the window from an array, row by row. Layers that the film does not keep are
    /// ignored.
    void set_layers(const Window& block, const PixelLayers* layers);

    /// The values of all layers as one array, and the inverse for a film that keeps the same layers.
    std::vector<double> layer_values() const;
    void set_layer_values(const std::vector<double>& values);

    /// Memory of a film with these layers.
    static double bytes_per_pixel(const std::vector<ImageLayer>& layers);

private:
    std::map<ImageLayer, LayerPlane> planes_;
};

}  // namespace deburr
