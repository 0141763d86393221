#include "raytracer/image/surroundings_file.hpp"

#include <fmt/format.h>

#include "raytracer/image/image_difference.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

std::shared_ptr<const Surroundings> read_surroundings(const std::string& path) {
    const Film film = read_picture(path);
    const bool for_display = image_kind(path) == ImageKind::display;
    auto picture = std::make_shared<Surroundings>();
    picture->width = film.window.width;
    picture->height = film.window.height;
    picture->rgb.reserve(3 * film.pixels.size());
    double sum = 0;
    for (const Pixel& pixel : film.pixels)
        for (int k = 0; k < 3; ++k) {
            const double value = for_display ? linear_of_srgb(pixel.color[k]) : pixel.color[k];
            if (!(value >= 0 && std::isfinite(float(value))))
                throw UsageError(fmt::format("environment '{}': expected finite numbers >= 0, got {}", path, value));
            picture->rgb.push_back(float(value));
            sum += value;
        }
    if (!(sum > 0)) throw UsageError(fmt::format("environment '{}': expected some light, got a black picture", path));
    return picture;
}

void load(Background& background) {
    if (!background.file.empty()) background.picture = read_surroundings(background.file);
}

}  // namespace

void load_surroundings(Scene& scene) {
    load(scene.background);
    if (scene.environment) load(*scene.environment);
}

}  // namespace deburr
