#include "raytracer/image/scene_pictures.hpp"

#include <fmt/format.h>

#include <map>

#include "raytracer/image/image_difference.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

enum class Use { light, color, share, height };

struct LoadedPicture {
    std::shared_ptr<const PictureData> data;
    Vec3 mean{0.0};
};

// Throws UsageError if the value is not allowed for the use.
void check_value(const std::string& path, Use use, double value) {
    const char* owner = use == Use::light ? "environment" : "image_map";
    const char* expected = use == Use::light    ? "finite numbers >= 0"
                           : use == Use::height ? "finite numbers"
                                                : "numbers from 0 to 1";
    const bool fine =
        std::isfinite(float(value)) && (use == Use::height || (value >= 0 && (use == Use::light || value <= 1)));
    if (!fine) throw UsageError(fmt::format("{} '{}': expected {}, got {}", owner, path, expected, value));
}

LoadedPicture read(const std::string& path, Use use) {
    const Film film = read_picture(path);
    const bool linear = use == Use::share || use == Use::height || image_kind(path) != ImageKind::display;
    auto picture = std::make_shared<PictureData>();
    picture->width = film.window.width;
    picture->height = film.window.height;
    picture->rgb.reserve(3 * film.pixels.size());
    Vec3 sum(0.0);
    for (const Pixel& pixel : film.pixels)
        for (int k = 0; k < 3; ++k) {
            const double value = linear ? pixel.color[k] : linear_of_srgb(pixel.color[k]);
            check_value(path, use, value);
            picture->rgb.push_back(float(value));
            sum[k] += value;
        }
    if (use == Use::light && !(sum.x + sum.y + sum.z > 0))
        throw UsageError(fmt::format("environment '{}': expected some light, got a black picture", path));
    return {std::move(picture), sum / double(film.pixels.size())};
}

class Pictures {
public:
    void load(Background& background) {
        if (!background.file.empty()) background.picture = get(background.file, Use::light).data;
    }
    void load(Texture& texture, Use use) {
        if (texture.file.empty()) return;
        const LoadedPicture& picture = get(texture.file, use);
        texture.data = picture.data;
        texture.a = texture.b = picture.mean;
    }
    /// Loads a texture's image, if it has one; `mean`, if not null, is set to the image's mean.
    void load(std::shared_ptr<const Texture>& texture, Use use, double* mean = nullptr) {
        if (!texture || texture->file.empty()) return;
        Texture loaded = *texture;
        load(loaded, use);
        if (mean) *mean = (loaded.a.x + loaded.a.y + loaded.a.z) / 3;
        texture = std::make_shared<const Texture>(std::move(loaded));
    }

private:
    const LoadedPicture& get(const std::string& path, Use use) {
        LoadedPicture& picture = pictures_[{path, use}];
        if (!picture.data) picture = read(path, use);
        return picture;
    }
    std::map<std::pair<std::string, Use>, LoadedPicture> pictures_;
};

}  // namespace

void load_pictures(Scene& scene) {
    Pictures pictures;
    pictures.load(scene.background);
    if (scene.environment) pictures.load(*scene.environment);
    load_textures(scene);
}

void load_textures(Scene& scene) {
    Pictures pictures;
    for (Material& m : scene.materials) {
        pictures.load(m.color, Use::color);
        pictures.load(m.roughness_texture, Use::share, &m.roughness);
        pictures.load(m.metallic_texture, Use::share, &m.metallic);
        pictures.load(m.bump, Use::height);
    }
}

}  // namespace deburr
