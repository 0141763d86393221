// Compares two pictures of one scene pixel by pixel: what their rays hit, and colour.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"

namespace deburr {

/// The layers that are compared besides colour and alpha.
std::vector<ImageLayer> compared_layers();

/// Statistics of differences over pixels.
struct DifferenceFigures {
    double mean = 0, p99 = 0, max = 0;  // p99: the 99th percentile
};

/// The difference of two pictures.
struct PictureDifference {
    std::size_t pixels = 0;
    std::size_t on_object = 0;  // pixels where a ray of either picture hit a counted solid
    std::size_t only_first = 0, only_second = 0,
                other_solid = 0;                // pixels hit in one picture only, or with different solids
    std::optional<DifferenceFigures> distance;  // of the hits; in radii if in_radii
    bool in_radii = false;
    std::optional<DifferenceFigures> normal_degrees;
    double rmse = 0;              // over linear R, G and B
    double psnr = infinity;       // in dB for a peak of 1
    double perceptual_fails = 0;  // pixels that are visibly different [Yee 1999], by OpenImageIO
};

/// The difference of two films with the same window. `radii` has the unit of distances for each solid; if it is empty,
/// the unit is the scene's. A solid with radius 0 (sharp or unbounded) is measured in the least radius of all and does
/// not count for on_object. Distances and angles are known only if both films keep those layers.
PictureDifference difference(const Film& a, const Film& b, const std::vector<double>& radii);

/// Writes an image of the colour differences. An EXR also gets the channels `hit` (1: only the first, 2: only the
/// second, 3: different solids), and `distance` and `angle` (degrees) where they are known. Throws WorkError.
void write_difference(const std::string& path, const Film& a, const Film& b);

/// Reads a picture with the layers that it has. Throws UsageError if that fails.
Film read_picture(const std::string& path);

}  // namespace deburr
