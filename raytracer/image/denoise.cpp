#include "raytracer/image/denoise.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "raytracer/image/oidn.hpp"

namespace deburr {
namespace {

// Rounds with steps of 1, 2, 4, … pixels between the 5 × 5 weighted pixels: a reach of 30 pixels.
constexpr int rounds = 4;
constexpr double spline[3] = {3.0 / 8, 1.0 / 4, 1.0 / 16};
// Differences at which a pixel's weight falls to 1/e: of the square root of light in the first round (halved in each
// further one), of normals, and of albedo.
constexpr double light_spread = 0.5, normal_spread = 0.15, albedo_spread = 0.05;
// Least albedo that colours are divided by.
constexpr double least_albedo = 0.02;

double square(Vec3 v) { return glm::dot(v, v); }

struct Guide {
    Vec3 normal{0.0}, albedo{0.0};
};

constexpr Denoiser denoisers[] = {Denoiser::none, Denoiser::wavelets, Denoiser::oidn};

}  // namespace

const char* name(Denoiser denoiser) {
    switch (denoiser) {
        case Denoiser::none: return "none";
        case Denoiser::wavelets: return "wavelets";
        case Denoiser::oidn: return "oidn";
    }
    return "";
}

std::optional<Denoiser> find_denoiser(std::string_view text) {
    for (const Denoiser denoiser : denoisers)
        if (name(denoiser) == text) return denoiser;
    return {};
}

void denoise(Film& film, Denoiser denoiser, int threads) {
    if (denoiser == Denoiser::wavelets) denoise(film);
    if (denoiser == Denoiser::oidn) denoise_by_oidn(film, threads);
}

void denoise(Film& film) {
    const LayerPlane &normals = film.layer(ImageLayer::guide_normal), &albedos = film.layer(ImageLayer::albedo);
    const int width = film.window.width, height = film.window.height;
    std::vector<Guide> guides(film.pixels.size());
    std::vector<Vec3> light(film.pixels.size()), smoothed(film.pixels.size());
    for (std::size_t i = 0; i < guides.size(); ++i) {
        guides[i] = {normals.vec(i), albedos.vec(i)};
        // Where nothing was hit, all is background, and its colour counts as light.
        const Vec3 albedo = film.pixels[i].alpha > 0 ? glm::max(guides[i].albedo, Vec3(least_albedo)) : Vec3(1.0);
        light[i] = film.pixels[i].color / albedo;
    }
    for (int round = 0; round < rounds; ++round) {
        const int step = 1 << round;
        const double spread = light_spread / step;
        tbb::parallel_for(0, height, [&](int y) {
            for (int x = 0; x < width; ++x) {
                const std::size_t here = std::size_t(y) * width + x;
                const Vec3 seen = glm::sqrt(glm::max(light[here], Vec3(0.0)));
                Vec3 sum(0.0);
                double weights = 0;
                for (int j = -2; j <= 2; ++j)
                    for (int i = -2; i <= 2; ++i) {
                        const int to_x = x + i * step, to_y = y + j * step;
                        if (to_x < 0 || to_y < 0 || to_x >= width || to_y >= height) continue;
                        const std::size_t there = std::size_t(to_y) * width + to_x;
                        const Vec3 difference = glm::sqrt(glm::max(light[there], Vec3(0.0))) - seen;
                        const double apart =
                            square(difference) / (spread * spread) +
                            square(guides[there].normal - guides[here].normal) / (normal_spread * normal_spread) +
                            square(guides[there].albedo - guides[here].albedo) / (albedo_spread * albedo_spread);
                        const double weight = spline[std::abs(i)] * spline[std::abs(j)] * std::exp(-apart);
                        sum += weight * light[there];
                        weights += weight;
                    }
                smoothed[here] = sum / weights;
            }
        });
        std::swap(light, smoothed);
    }
    for (std::size_t i = 0; i < guides.size(); ++i) {
        const Vec3 albedo = film.pixels[i].alpha > 0 ? glm::max(guides[i].albedo, Vec3(least_albedo)) : Vec3(1.0);
        film.pixels[i].color = light[i] * albedo;
    }
}

}  // namespace deburr
