#include "raytracer/image/exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace deburr {
namespace {

// Share of pixels that may be clipped without a warning (chosen): highlights, lamps and small skies may be.
constexpr double tolerated_share = 0.05;
// Share of pixels that may still be clipped at the proposed exposure.
constexpr double left_share = 0.01;
// A picture is nearly black if all but that share of its pixels are darker than this: 36 of 255 in sRGB.
constexpr double nearly_black = 0.018;

// The proposed exposure is rounded to this, in stops.
constexpr double step = 0.1;

// The value that only `left_share` of the pixels exceed is the one with this number in rising order.
std::size_t rank_of_shown(std::size_t pixels) { return std::size_t((1 - left_share) * double(pixels - 1)); }

// The exposure, in stops, that shows all but `left_share` of the pixels as at most white, rounded down to a step.
double exposure_that_shows(const Film& film) {
    std::vector<double> brightest;
    brightest.reserve(film.pixels.size());
    for (const Pixel& pixel : film.pixels) brightest.push_back(max_component(pixel.color));
    const auto at = brightest.begin() + std::ptrdiff_t(rank_of_shown(brightest.size()));
    std::nth_element(brightest.begin(), at, brightest.end());
    return step * std::floor(-std::log2(*at) / step);
}

}  // namespace

std::optional<std::string> exposure_advice(const Film& film, double exposure) {
    if (film.pixels.empty()) return std::nullopt;
    // Most pictures are well exposed, which counting tells without memory for their values.
    const double scale = std::exp2(exposure);
    std::size_t lit = 0, dark = 0, clipped = 0, covered = 0;
    for (const Pixel& pixel : film.pixels) {
        const double shown = scale * max_component(pixel.color);
        lit += shown != 0;
        dark += shown < nearly_black;
        clipped += shown > 1;
        covered += pixel.alpha > 0;
    }
    const std::size_t all = film.pixels.size();
    if (lit == 0) {
        if (covered == 0) return std::nullopt;
        return "the picture is black: no light falls on what the camera sees";
    }
    if (double(clipped) > tolerated_share * double(all))
        return fmt::format("{:.0f} % of the pixels are brighter than white and clipped; --exposure {:.1f} shows them",
                           100 * double(clipped) / double(all), exposure_that_shows(film));
    // Where all but a few pixels are black, no exposure shows them.
    if (dark > rank_of_shown(all))
        if (const double shows = exposure_that_shows(film); std::isfinite(shows))
            return fmt::format("the picture is nearly black; --exposure {:.1f} shows it", shows);
    return std::nullopt;
}

}  // namespace deburr
