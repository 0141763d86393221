#include "raytracer/image/exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace deburr {
namespace {

// Highlights, lamps and small skies may be clipped; a picture that loses more has lost something. Chosen.
constexpr double tolerated_share = 0.05;
// Pixels that may still be clipped at the exposure that is proposed.
constexpr double left_share = 0.01;
// A picture whose brightest pixels, but for that share, show as less than this is nearly black: sRGB's 36 of 255.
constexpr double nearly_black = 0.018;

// A step of the scale that people read, in stops.
constexpr double step = 0.1;

}  // namespace

std::optional<std::string> exposure_advice(const Film& film, double exposure) {
    if (film.pixels.empty()) return std::nullopt;
    std::vector<double> brightest;
    brightest.reserve(film.pixels.size());
    const double scale = std::exp2(exposure);
    for (const Pixel& pixel : film.pixels)
        brightest.push_back(scale * std::max({pixel.color.x, pixel.color.y, pixel.color.z}));
    const bool is_black = std::all_of(brightest.begin(), brightest.end(), [](double x) { return x == 0; });
    const bool sees_something =
        std::any_of(film.pixels.begin(), film.pixels.end(), [](const Pixel& pixel) { return pixel.alpha > 0; });
    if (is_black && sees_something) return "the picture is black: no light falls on what the camera sees";
    const double all = double(brightest.size());
    const double clipped = double(std::count_if(brightest.begin(), brightest.end(), [](double x) { return x > 1; }));
    const auto at = brightest.begin() + std::ptrdiff_t((1 - left_share) * (all - 1));
    std::nth_element(brightest.begin(), at, brightest.end());
    const double stops = exposure - std::log2(*at);
    if (clipped > tolerated_share * all)
        return fmt::format("{:.0f} % of the pixels are brighter than white and clipped; --exposure {:.1f} shows them",
                           100 * clipped / all, step * std::floor(stops / step));
    if (*at > 0 && *at < nearly_black)
        return fmt::format("the picture is nearly black; --exposure {:.1f} shows it", step * std::floor(stops / step));
    return std::nullopt;
}

}  // namespace deburr
