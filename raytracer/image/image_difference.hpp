// How far two pictures of one scene are apart: pixel by pixel, in what their rays hit and in colour.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"

namespace deburr {

/// Layers that are compared beside colour and alpha.
std::vector<ImageLayer> compared_layers();

struct DifferenceFigures {
    double mean = 0, p99 = 0, max = 0;  // p99: 99 % are below it
};

struct PictureDifference {
    std::size_t pixels = 0;
    std::size_t on_object = 0;  // pixels where either ray hit a solid that counts
    std::size_t only_first = 0, only_second = 0, other_solid = 0;
    std::optional<DifferenceFigures> distance;  // of the hits, in radii where they are known
    bool in_radii = false;
    std::optional<DifferenceFigures> normal_degrees;
    double rmse = 0;              // of linear R, G, B
    double psnr = infinity;       // dB against 1
    double perceptual_fails = 0;  // pixels visibly different, after Yee 1999, as OpenImageIO has it
};

/// `radii`: by solid, the unit of distances; empty: the scene's own unit. Solids whose radius is 0
/// (sharp or unbounded ones) count with the least radius there is, and not as the object.
/// Both films have the same window; distances and angles are known where both keep those layers.
PictureDifference difference(const Film& a, const Film& b, const std::vector<double>& radii);

/// Writes colour differences; an EXR also has `hit` (1: only the first, 2: only the second, 3: another
/// solid), and `distance` and `angle` (degrees) where they are known. Throws WorkError.
void write_difference(const std::string& path, const Film& a, const Film& b);

/// Reads a picture with whatever layers it has. Throws UsageError if it cannot be read.
Film read_picture(const std::string& path);

}  // namespace deburr
