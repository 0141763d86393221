// The built-in denoiser on pictures with known edges.
#include "raytracer/image/denoise.hpp"

#include <random>

#include "catch.hpp"

using namespace deburr;

namespace {

// A noisy picture: a dark surface on the left and a bright one on the right; the normals of the lower half differ.
Film noisy(double noise) {
    const int side = 48;
    Film film(side, side, {0, 0, side, side}, {ImageLayer::guide_normal, ImageLayer::albedo});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<PixelLayers> layers(side * side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            PixelLayers& l = layers[y * side + x];
            l.albedo = Vec3(x < side / 2 ? 0.2 : 0.8);
            l.guide_normal = y < side / 2 ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
            const double light = (y < side / 2 ? 1.0 : 0.5) * (1 + noise * uniform(random));
            film.at(x, y) = {light * l.albedo, 1};
        }
    film.set_layers(film.window, layers.data());
    return film;
}

double error(const Film& film) {
    const Film exact = noisy(0);
    double sum = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        sum += std::pow(film.pixels[i].color.x - exact.pixels[i].color.x, 2);
    return std::sqrt(sum / double(film.pixels.size()));
}

}  // namespace

TEST_CASE("Noise within surfaces is smoothed, and edges of colour and of normals stay") {
    Film film = noisy(0.3);
    const double before = error(film);
    denoise(film);
    CHECK(error(film) < before / 5);
    CHECK(film.at(23, 10).color.x == Approx(0.2).epsilon(0.1));
    CHECK(film.at(24, 10).color.x == Approx(0.8).epsilon(0.1));
    CHECK(film.at(40, 23).color.x == Approx(0.8).epsilon(0.1));
    CHECK(film.at(40, 24).color.x == Approx(0.4).epsilon(0.1));
}

TEST_CASE("A picture without noise stays as it is") {
    Film film = noisy(0);
    denoise(film);
    CHECK(error(film) < 1e-3);
}
