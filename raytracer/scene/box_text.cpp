#include "raytracer/scene/box_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace deburr {
namespace {

// Removes the slack, which is some 10⁻⁹ of the box's largest coordinate.
double without_slack(double x, double largest) {
    constexpr double digits = 1e8;
    const double unit = std::pow(10.0, std::ceil(std::log10(std::max(largest, 1.0))) + 1);
    return std::isfinite(x) ? std::round(x / unit * digits) / digits * unit : x;
}

std::string text_of(double x, double largest) {
    return std::isfinite(x) ? fmt::format("{:.6g}", without_slack(x, largest) + 0.0) : x > 0 ? "inf" : "-inf";
}

}  // namespace

std::string box_text(const Box& box) {
    if (box.empty()) return "empty";
    double largest = 0;
    for (int k = 0; k < 3; ++k)
        for (const double side : {box.lo[k], box.hi[k]})
            if (std::isfinite(side)) largest = std::max(largest, std::abs(side));
    std::string ranges[3];
    for (int k = 0; k < 3; ++k)
        ranges[k] = fmt::format("[{}, {}]", text_of(box.lo[k], largest), text_of(box.hi[k], largest));
    if (ranges[0] == ranges[1] && ranges[1] == ranges[2]) return ranges[0] + "³";
    return ranges[0] + " x " + ranges[1] + " x " + ranges[2];
}

}  // namespace deburr
