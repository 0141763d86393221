#include "raytracer/render/daylight.hpp"

#include <algorithm>

namespace deburr {
namespace {

constexpr double kilocandelas_of_one = 30;
constexpr int sky_width = 512, sky_height = 256;
// Least height, since Perez' formula divides by the cosine of the zenith angle.
constexpr double least_height = 0.01;

// Perez' five parameters, which are linear in the turbidity [Preetham et al., appendix A.2].
struct Perez {
    double A, B, C, D, E;

    double operator()(double cos_zenith, double cos_sun) const {
        const double gamma = std::acos(glm::clamp(cos_sun, -1.0, 1.0));
        return (1 + A * std::exp(B / cos_zenith)) * (1 + C * std::exp(D * gamma) + E * cos_sun * cos_sun);
    }
};

Perez luminance(double T) {
    return {0.1787 * T - 1.4630, -0.3554 * T + 0.4275, -0.0227 * T + 5.3251, 0.1206 * T - 2.5771, -0.0670 * T + 0.3703};
}
Perez chroma_x(double T) {
    return {-0.0193 * T - 0.2592, -0.0665 * T + 0.0008, -0.0004 * T + 0.2125, -0.0641 * T - 0.8989,
            -0.0033 * T + 0.0452};
}
Perez chroma_y(double T) {
    return {-0.0167 * T - 0.2608, -0.0950 * T + 0.0092, -0.0079 * T + 0.2102, -0.0441 * T - 1.6537,
            -0.0109 * T + 0.0529};
}

// A chromaticity at the zenith; the matrix's rows belong to T², T and 1, its columns to powers of the sun's angle from
// 3 down to 0.
double zenith_chroma(const double (&m)[3][4], double T, double angle) {
    const double powers[4] = {angle * angle * angle, angle * angle, angle, 1}, turbidities[3] = {T * T, T, 1};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 4; ++k) sum += turbidities[i] * m[i][k] * powers[k];
    return sum;
}

constexpr double zenith_x[3][4] = {
    {0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}};
constexpr double zenith_y[3][4] = {
    {0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}};

double zenith_luminance(double T, double angle) {
    const double chi = (4.0 / 9 - T / 120) * (pi - 2 * angle);
    return (4.0453 * T - 4.9710) * std::tan(chi) - 0.2155 * T + 2.4192;
}

// Converts CIE xyY to linear Rec. 709 [IEC 61966-2-1].
Vec3 rgb_of(double x, double y, double Y) {
    const double X = x / y * Y, Z = (1 - x - y) / y * Y;
    return glm::max(Vec3(3.2406 * X - 1.5372 * Y - 0.4986 * Z, -0.9689 * X + 1.8758 * Y + 0.0415 * Z,
                         0.0557 * X - 0.2040 * Y + 1.0570 * Z),
                    Vec3(0.0));
}

Vec3 raised(Vec3 sun) {
    sun = glm::normalize(sun);
    sun.y = std::max(sun.y, least_height);
    return glm::normalize(sun);
}

}  // namespace

std::shared_ptr<const PictureData> daylight(const Background& background) {
    const double T = background.turbidity;
    const Vec3 sun = raised(background.sun);
    const double angle = std::acos(sun.y);
    const Perez Y = luminance(T), x = chroma_x(T), y = chroma_y(T);
    const double scale_Y = zenith_luminance(T, angle) / Y(1, sun.y) / kilocandelas_of_one;
    const double scale_x = zenith_chroma(zenith_x, T, angle) / x(1, sun.y);
    const double scale_y = zenith_chroma(zenith_y, T, angle) / y(1, sun.y);
    auto sky = std::make_shared<PictureData>();
    sky->width = sky_width;
    sky->height = sky_height;
    sky->rgb.resize(3 * std::size_t(sky_width) * sky_height);
    for (int j = 0; j < sky_height; ++j)
        for (int i = 0; i < sky_width; ++i) {
            const double phi = 2 * pi * ((i + 0.5) / sky_width - 0.5);
            const double height = std::max(std::cos(pi * (j + 0.5) / sky_height), least_height);
            const double sine = std::sqrt(1 - height * height);
            const double to_sun = glm::dot(sun, Vec3(sine * std::sin(phi), height, -sine * std::cos(phi)));
            const Vec3 color = rgb_of(scale_x * x(height, to_sun), scale_y * y(height, to_sun),
                                      std::max(0.0, scale_Y * Y(height, to_sun)));
            for (int k = 0; k < 3; ++k) sky->rgb[3 * (std::size_t(j) * sky_width + i) + k] = float(color[k]);
        }
    return sky;
}

// The sunlight that air, haze and ozone transmit, at one wavelength for each channel [Preetham et al., appendix A.1].
Vec3 sun_irradiance(const Background& background) {
    constexpr double outside = 128;  // kilolux above the atmosphere
    const double wavelengths[3] = {0.61, 0.55, 0.465}, ozone[3] = {0.120, 0.085, 0.010};  // µm; 1/cm of ozone
    if (!(background.sun.y > 0)) return Vec3(0.0);
    const double degrees = std::acos(raised(background.sun).y) * 180 / pi;
    const double mass = 1 / (std::cos(degrees * pi / 180) + 0.15 * std::pow(93.885 - degrees, -1.253));
    const double haze = std::max(0.0, 0.04608 * background.turbidity - 0.04586);
    Vec3 passed;
    for (int k = 0; k < 3; ++k)
        passed[k] = std::exp(-mass * (0.008735 * std::pow(wavelengths[k], -4.08) +
                                      haze * std::pow(wavelengths[k], -1.3) + ozone[k] * 0.35));
    return passed * (background.scale * outside / kilocandelas_of_one);
}

}  // namespace deburr
