// Denoising by Open Image Denoise, through a stand-in for the library.
#include "raytracer/image/oidn.hpp"

#include <dlfcn.h>

#include <random>

#include "catch.hpp"
#include "raytracer/image/denoise.hpp"
#include "raytracer/program.hpp"
#include "raytracer/util/errors.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

Film random_film() {
    Film film(20, 10, {3, 2, 9, 6}, {ImageLayer::guide_normal, ImageLayer::albedo});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto vec = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    std::vector<PixelLayers> layers(film.pixels.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers[i].albedo = vec();
        layers[i].guide_normal = glm::normalize(vec());
        film.pixels[i] = {3.0 * vec(), uniform(random)};
    }
    film.set_layers(film.window, layers.data());
    return film;
}

}  // namespace

// The stand-in is loaded first; the loader then takes it for the library of the same name.
TEST_CASE("Open Image Denoise gets colour, albedo and normal, and its output becomes the colour") {
    REQUIRE(dlopen(DEBURR_OIDN_STAND_IN "/libOpenImageDenoise.so.2", RTLD_NOW));
    const Film before = random_film();
    Film film = before;
    denoise(film, Denoiser::oidn, 2);
    int right = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const Vec3 expected = 0.5 * before.pixels[i].color + 0.3 * before.layer(ImageLayer::albedo).vec(i) +
                              0.2 * before.layer(ImageLayer::guide_normal).vec(i);
        right += glm::length(film.pixels[i].color - expected) < 1e-6 && film.pixels[i].alpha == before.pixels[i].alpha;
    }
    CHECK(right == 54);
    CHECK_THROWS_WITH(denoise(film, Denoiser::oidn, 9), "--denoise=oidn: too many threads");
}

TEST_CASE("--denoise=oidn is one line where the system has no such library, before anything is rendered") {
    const Folder folder;
    write_file(folder / "scene.lua", cube_scene());
    const auto render = [&](const std::string& denoise, const std::vector<std::string>& environment = {}) {
        return run({"render", folder / "scene.lua", "-q", denoise, "--spp", "4", "-o", folder / "picture.exr"},
                   environment);
    };
    const Outcome with = render("--denoise=oidn", {"LD_LIBRARY_PATH=" DEBURR_OIDN_STAND_IN});
    CHECK(with.err == "");
    CHECK(with.code == 0);
    CHECK(folder.names() == std::vector<std::string>{"picture.exr", "scene.lua"});

    const Outcome unknown = render("--denoise=magic");
    CHECK(unknown.code == 2);
    CHECK_THAT(unknown.err, Catch::Matchers::Contains("--denoise: expected wavelets or oidn, got 'magic'"));
    const Outcome plain = render("--denoise");
    CHECK(plain.code == 0);
    std::filesystem::remove(folder / "picture.exr");
    const Outcome without = render("--denoise=oidn");
    if (without.code == 0) return;  // the library is installed
    CHECK(without.code == 3);
    CHECK_THAT(without.err, Catch::Matchers::StartsWith("deburr: --denoise=oidn needs libOpenImageDenoise.so.2: "));
    CHECK(folder.names() == std::vector<std::string>{"scene.lua"});
}
