// Textures, pictures on surfaces and bumps against closed forms.
#include "raytracer/render/textures.hpp"

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"
#include "raytracer/render/bump.hpp"
#include "raytracer/render/image_map.hpp"

using namespace deburr;

namespace {

Texture pattern(Texture::Kind kind) {
    Texture t;
    t.kind = kind;
    t.a = Vec3(0);
    t.b = Vec3(1);
    return t;
}

// A picture texture of grey pixels, row by row from the top.
Texture picture(int width, int height, const std::vector<double>& greys) {
    PictureData data{width, height, {}};
    for (const double grey : greys) data.rgb.insert(data.rgb.end(), 3, float(grey));
    Texture t = pattern(Texture::Kind::image);
    t.data = std::make_shared<const PictureData>(std::move(data));
    return t;
}

Vec3 random_direction(int i) {
    const Sampler sampler(5, i, 0, 0);
    const Vec2 u = sampler.square(0);
    const double z = 2 * u.x - 1, r = std::sqrt(1 - z * z);
    return {r * std::cos(2 * pi * u.y), r * std::sin(2 * pi * u.y), z};
}

double path_value(const Scene& scene, const RayTracer& tracer, int spp) {
    TraceCounters counters;
    RenderSettings settings{1, 1, spp, 0};
    settings.integrator = IntegratorKind::path;
    return Integrator(scene, tracer, settings).pixel(0, 0, nullptr, counters).color.x;
}

}  // namespace

TEST_CASE("A picture is upright and readable on all six sides, with y up and with z up") {
    Texture t = picture(2, 2, {0.1, 0.2, 0.3, 0.4});
    t.scale = 2;
    t.origin = {5, 6, 7};
    struct Side {
        Vec3 normal, up;
    };
    const Side sides[] = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}},
                          {{0, 0, -1}, {0, 1, 0}}, {{0, 1, 0}, {0, 0, -1}}, {{0, -1, 0}, {0, 0, 1}}};
    int cases = 0;
    for (const bool z_up : {false, true})
        for (const Side& side : sides) {
            const auto turned = [&](Vec3 v) { return z_up ? Vec3(v.x, -v.z, v.y) : v; };
            t.z_up = z_up;
            const Vec3 normal = turned(side.normal), up = turned(side.up), right = glm::cross(up, normal);
            CAPTURE(z_up, side.normal.x, side.normal.y, side.normal.z);
            const auto at = [&](double x, double y) {
                return image_color(t, t.origin + x * right + y * up + 0.3 * normal, normal).x;
            };
            CHECK(at(0.5, 1.5) == Approx(0.1));
            CHECK(at(1.5, 1.5) == Approx(0.2));
            CHECK(at(0.5, 0.5) == Approx(0.3));
            CHECK(at(1.5, 0.5) == Approx(0.4));
            CHECK(at(1.0, 1.5) == Approx(0.15));   // between two pixels' centers
            CHECK(at(-1.5, 5.5) == Approx(0.1));   // the picture repeats
            CHECK(at(2.0, -2.0) == Approx(0.25));  // where four copies meet
            ++cases;
        }
    CHECK(cases == 12);
    t.z_up = false;
    t.rotate = 90;  // the upper left pixel is now the lower left one, left of the origin
    CHECK(image_color(t, t.origin + Vec3(-1.5, 0.5, 0), {0, 0, 1}).x == Approx(0.1));
    CHECK(image_color(t, t.origin + Vec3(-1.5, 1.5, 0), {0, 0, 1}).x == Approx(0.2));
}

TEST_CASE("Between two sides a picture is a blend, and never more or less than all of it") {
    Texture t = picture(2, 2, {0.1, 0.2, 0.3, 0.4});
    const Vec3 x(0.13, 0.41, 0.77), between = glm::normalize(Vec3(1, 1, 0));
    const double right = image_color(t, x, {1, 0, 0}).x, top = image_color(t, x, {0, 1, 0}).x;
    REQUIRE(std::abs(right - top) > 0.02);
    CHECK(image_color(t, x, between).x == Approx((right + top) / 2));
    CHECK(image_color(t, x, glm::normalize(Vec3(1, 0.74, 0))).x == Approx(right));
    // 0.9 exceeds 0.75 by 0.15 where 1 exceeds it by 0.25, so the weights are 0.15 and 0.25.
    CHECK(image_color(t, x, glm::normalize(Vec3(1, 0.9, 0))).x == Approx((0.25 * right + 0.15 * top) / 0.4));
    t.blend = 0;
    CHECK(image_color(t, x, glm::normalize(Vec3(1, 0.99, 0))).x == Approx(right));
    CHECK(image_color(t, x, glm::normalize(Vec3(0.99, 1, 0))).x == Approx(top));
    const Texture even = picture(3, 1, {0.6, 0.6, 0.6});
    for (int i = 0; i < 1000; ++i) CHECK(image_color(even, x * double(i), random_direction(i)).x == Approx(0.6));
}

TEST_CASE("Marble without turbulence is planes of veins, and with it lies between its colours") {
    Texture t = pattern(Texture::Kind::marble);
    t.turbulence = 0;
    t.scale = 2;
    t.axis = {0, 0, 1};
    for (const double x : {-3.0, 0.0, 7.5}) {
        CHECK(value_at(t, {x, 1, 4}, {0, 1, 0}) == Approx(1));
        CHECK(value_at(t, {x, 1, 1}, {0, 1, 0}) == Approx(0).margin(1e-12));
        CHECK(value_at(t, {x, 1, 2.0 / 3}, {0, 1, 0}) == Approx(1.0 / 32));
    }
    t.turbulence = 1;
    double least = 1, most = 0;
    for (int i = 0; i < 1000; ++i) {
        const double value = value_at(t, 9.0 * random_direction(i), {0, 1, 0});
        least = std::min(least, value);
        most = std::max(most, value);
    }
    CHECK(least >= 0);
    CHECK(least < 0.01);
    CHECK(most <= 1);
    CHECK(most > 0.9);
}

TEST_CASE("Noise is half of each colour at its lattice's points, and octaves make it finer") {
    Texture t = pattern(Texture::Kind::noise);
    t.scale = 0.5;
    const auto curvature = [&] {
        double sum = 0;
        for (int i = 0; i < 2000; ++i) {
            const auto at = [&](double aside) {
                return value_at(t, 9.0 * random_direction(i) + Vec3(aside, 0, 0), {0, 1, 0});
            };
            sum += std::abs(at(-0.01) - 2 * at(0) + at(0.01));
        }
        return sum;
    };
    for (const int octaves : {1, 4}) {
        t.octaves = octaves;
        CHECK(value_at(t, {1.5, -2, 3}, {0, 1, 0}) == 0.5);
    }
    const double fine = curvature();
    t.octaves = 1;
    CHECK(fine > 2 * curvature());
}

TEST_CASE("Streaks are long along their axis, and rings are the same all around it") {
    Texture t = pattern(Texture::Kind::brushed);
    t.axis = glm::normalize(Vec3(1, 2, 2));
    t.scale = 0.1;
    const Vec3 across = glm::normalize(glm::cross(t.axis, Vec3(0, 0, 1)));
    double along = 0, aside = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 x = 3.0 * random_direction(i);
        const double here = value_at(t, x, {0, 1, 0});
        along += std::abs(here - value_at(t, x + 0.1 * t.axis, {0, 1, 0}));
        aside += std::abs(here - value_at(t, x + 0.1 * across, {0, 1, 0}));
    }
    CHECK(along < 0.05 * aside);
    t.around = true;
    t.axis = {0, 1, 0};
    for (int i = 0; i < 100; ++i) {
        const double angle = i * 0.4, height = i * 0.013;
        CHECK(value_at(t, {0.7 * std::cos(angle), height, 0.7 * std::sin(angle)}, {0, 1, 0}) ==
              Approx(value_at(t, {0.7, height, 0}, {0, 1, 0})).margin(1e-9));
    }
}

TEST_CASE("A bump's normal is that of the heights") {
    // The heights rise by 1/8 from pixel to pixel, so by 1 over the width of 4.
    Texture ramp = picture(8, 1, {0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875});
    ramp.scale = 4;
    const Vec3 n = bumped_normal(ramp, 2, {1.9, 0.2, 0}, {0, 0, 1});
    CHECK(close(n, glm::normalize(Vec3(-0.5, 0, 1)), 1e-6));
    // Without turbulence marble's value is cos(πx)⁵, with slope −5π cos(πx)⁴ sin(πx).
    Texture planes = pattern(Texture::Kind::marble);
    planes.turbulence = 0;
    for (const double x : {0.1, 0.2, 0.3}) {
        const double slope = -5 * pi * std::pow(std::cos(pi * x), 4) * std::sin(pi * x);
        const Vec3 m = bumped_normal(planes, 0.1, {x, 3, 0}, {0, 1, 0});
        CHECK(close(m, glm::normalize(Vec3(-0.1 * slope, 1, 0)), 2e-3));
    }
    CHECK(bumped_normal(picture(2, 1, {0.5, 0.5}), 3, {0.2, 0.3, 0.4}, {0, 0, 1}) == Vec3(0, 0, 1));
}

TEST_CASE("What a visible bump mirrors to the eye comes from outside") {
    int bent = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 normal = random_direction(i), to_eye = random_direction(i + 20'000);
        const Vec3 bumped = glm::normalize(normal + 0.9 * random_direction(i + 40'000));
        if (!(glm::dot(normal, to_eye) > 0)) continue;
        const Vec3 n = visible_bump(bumped, normal, to_eye);
        CHECK(glm::length(n) == Approx(1).margin(1e-9));
        CHECK(glm::dot(n, to_eye) > 0);
        CHECK(glm::dot(reflected(to_eye, n), normal) > 0);
        const bool was_fine = glm::dot(bumped, to_eye) > 0 && glm::dot(reflected(to_eye, bumped), normal) > 1e-3;
        if (was_fine) CHECK(n == bumped);
        bent += !was_fine;
    }
    CHECK(bent > 2000);
}

TEST_CASE("A bumped mirror in a white world is white, and no bumped surface returns more than it gets") {
    using Kind = Material::Kind;
    for (const auto kind : {Kind::matte, Kind::plastic, Kind::metal, Kind::mirror, Kind::glass})
        for (const double at : {0.1, 0.6, 0.95}) {
            CAPTURE(int(kind), at);
            Material material = material_of(kind, Vec3(1.0), 0.3);
            Texture noise = pattern(Texture::Kind::noise);
            noise.scale = 0.1;
            material.bump = std::make_shared<const Texture>(noise);
            material.bump_height = 0.03;
            Scene scene = probe(material);
            scene.background.color = Vec3(1.0);
            scene.camera.eye = {at, 4, 0};
            scene.camera.target = {at, 0, 0};
            const double white = path_value(scene, AnalyticTracer({unit_sphere}), 1 << 14);
            if (kind == Kind::mirror) CHECK(white == Approx(1).margin(1e-9));
            CHECK(white < 1.005);
            CHECK(white > 0.8);
        }
}

TEST_CASE("A share from a texture is the material of that number, and what varies is white in a white world") {
    Material number = material_of(Material::Kind::pbr, {0.8, 0.5, 0.3}, 0.5);
    number.metallic = 0.25;
    Material texture = number;
    Texture half = pattern(Texture::Kind::checker);
    half.a = half.b = Vec3(0.5);
    texture.roughness_texture = std::make_shared<const Texture>(half);
    half.a = half.b = Vec3(0.25);
    texture.metallic_texture = std::make_shared<const Texture>(half);
    texture.roughness = texture.metallic = 0.9;
    Scene scene = probe(number);
    scene.background.sky = true;
    scene.camera.eye = {0.4, 4, 0};
    const AnalyticTracer tracer({unit_sphere});
    const double expected = path_value(scene, tracer, 64);
    scene.materials = {texture};
    CHECK(path_value(scene, tracer, 64) == expected);

    Texture spots = pattern(Texture::Kind::noise);
    spots.scale = 0.2;
    texture.color = plain_texture(1.0);
    texture.roughness_texture = texture.metallic_texture = std::make_shared<const Texture>(spots);
    scene = probe(texture);
    scene.background.color = Vec3(1.0);
    for (const double at : {0.0, 0.33, 0.7, 0.9}) {
        scene.camera.eye = {at, 4, 0};
        scene.camera.target = {at, 0, 0};
        CHECK(path_value(scene, tracer, 1 << 16) == Approx(1).margin(2e-3));
    }
}
