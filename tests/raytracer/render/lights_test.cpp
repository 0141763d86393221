// Every kind of light, skies and environment pictures against closed forms.
#include "raytracer/render/lights.hpp"

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"
#include "raytracer/render/closed_forms.hpp"
#include "raytracer/render/textures.hpp"

using namespace deburr;

namespace {

// A matte ground y = 0 of reflectance 1 seen from above, so that its radiance is irradiance/π.
Scene ground_under(Light light) {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    scene.materials.push_back(material_of(Material::Kind::matte, Vec3(0.0)));  // for walls, which reflect nothing
    light.visible = false;                                                     // so that the camera may look through it
    scene.lights = {light};
    return scene;
}

double irradiance(const Light& light, const std::vector<AnalyticShape>& shapes, int spp = 1) {
    return pixel_of(ground_under(light), AnalyticTracer(shapes), spp).color.x * pi;
}

}  // namespace

TEST_CASE("A point light follows the inverse-square and the cosine law in watts") {
    Light light;
    light.power = 100;
    light.color = Vec3(0.5);
    for (double height : {0.5, 1.0, 3.0})
        for (double aside : {0.0, 1.0, 7.0}) {
            light.position = {aside, height, 0};
            const double d2 = height * height + aside * aside;
            const double expected = 100 * 0.5 / (4 * pi) / d2 * height / std::sqrt(d2);
            CHECK(irradiance(light, {floor_at(0)}) == Approx(expected).epsilon(1e-9));
        }
    light.position = {0, -1, 0};  // below the ground
    CHECK(irradiance(light, {floor_at(0)}) == 0);
    light.position = {0, 0, 0};  // at the shaded point itself
    CHECK(irradiance(light, {floor_at(0)}) == 0);
}

TEST_CASE("A directional light's power is the irradiance on a surface that faces it") {
    Light light;
    light.kind = Light::Kind::directional;
    light.power = 3;
    light.direction = {0, -1, 0};
    CHECK(irradiance(light, {floor_at(0)}) == Approx(3).epsilon(1e-12));
    light.direction = glm::normalize(Vec3(1, -1, 0));
    CHECK(irradiance(light, {floor_at(0)}) == Approx(3 / std::sqrt(2.0)).epsilon(1e-12));
    // A sphere that is far away against the light's direction still casts a shadow.
    const AnalyticShape far{AnalyticShape::Kind::sphere, {-1e3, 1e3, 0}, {}, 1, 0};
    CHECK(irradiance(light, {floor_at(0), far}) == 0);
}

TEST_CASE("An area light's irradiance is its form factor times its flux density") {
    Light light;
    light.kind = Light::Kind::area;
    light.power = 50;
    light.u = {2, 0, 0};
    light.v = {0, 0, 1};
    light.position = {1, 1, 0.5};  // a corner is above the point
    std::swap(light.u, light.v);
    CHECK(irradiance(light, {floor_at(0)}, 64) == 0);  // u × v points up, so the light shines up
    std::swap(light.u, light.v);
    for (int samples : {1, 16}) {
        light.samples = samples;
        const double expected = 50.0 / 2 * corner_form_factor(2, 1);
        CHECK(irradiance(light, {floor_at(0)}, 1024) == Approx(expected).epsilon(0.002));
    }
}

TEST_CASE("In a penumbra the visible part of the light counts") {
    // A square light above the point; a wall hides its half with x < 0.
    Light light;
    light.kind = Light::Kind::area;
    light.power = 10;
    light.u = {2, 0, 0};
    light.v = {0, 0, 2};
    light.position = {0, 2, 0};
    light.samples = 4;
    const double open = irradiance(light, {floor_at(0)}, 1024);
    CHECK(open == Approx(10.0 / 4 * 4 * corner_form_factor(0.5, 0.5)).epsilon(0.002));
    const AnalyticShape wall{AnalyticShape::Kind::slab, {-1e-6, 0, 0}, {1, 0, 0}, 0.5, 1};
    CHECK(irradiance(light, {floor_at(0), wall}, 1024) == Approx(open / 2).epsilon(0.004));
    // The tilted wall leaves only the part x > ½ of the light visible: twice the difference of two corner form factors.
    const AnalyticShape tilted{AnalyticShape::Kind::plane, {-1e-6, 0, 0}, glm::normalize(Vec3(4, -1, 0)), 0, 1};
    const double part = 2 * (corner_form_factor(0.5, 0.5) - corner_form_factor(0.25, 0.5));
    Scene scene = ground_under(light);
    scene.camera.eye = {4, 4, 0};
    scene.camera.up = {0, 1, 0};
    const AnalyticTracer tracer({floor_at(0), tilted});
    CHECK(pixel_of(scene, tracer, 1 << 15).color.x * pi == Approx(10.0 / 4 * part).epsilon(0.004));
}

TEST_CASE("A polished floor and a rough one reflect an area light alike by light and by layer") {
    // The estimate by samples of both kinds against a sum over the light alone.
    Light light;
    light.kind = Light::Kind::area;
    light.power = 20;
    light.u = {1.5, 0, 0};
    light.v = {0, 0, 1.5};
    light.position = {0.3, 2, 0.2};
    int cases = 0;
    for (auto kind : {Material::Kind::metal, Material::Kind::plastic})
        for (double roughness : {0.25, 0.5, 0.9}) {
            CAPTURE(int(kind), roughness);
            Scene scene = probe(material_of(kind, Vec3(0.8), roughness));
            light.samples = 1;
            scene.lights = {light};
            scene.camera.eye = {-0.3, 2, 0};
            const AnalyticTracer tracer({floor_at(0)});
            const double both = pixel_of(scene, tracer, 4096).color.x;
            scene.lights[0].samples = 4096;
            const double light_only = pixel_of(scene, tracer, 1).color.x;  // a preview
            CHECK(light_only > 0.05);
            CHECK(both == Approx(light_only).epsilon(0.01));
            ++cases;
        }
    CHECK(cases == 6);
}

TEST_CASE("The sky's mean is that of its radiance weighted by the cosine") {
    Background gradient;
    gradient.sky = true;
    gradient.horizon = Vec3(1.0);
    gradient.zenith = Vec3(0.0);
    const SkyLight sky(gradient);
    // The mean is 1 − 2·∫√y·y dy = 1/5 for a surface that faces up, and the horizon's colour for one that faces down.
    CHECK(sky.mean({0, 1, 0}).x == Approx(0.2).margin(1e-3));
    CHECK(sky.mean({0, -1, 0}).x == Approx(1.0).margin(1e-3));
    int cases = 0;
    for (double y : {-0.93, -0.4, 0.01, 0.33, 0.72}) {
        const Vec3 normal(std::sqrt(1 - y * y), y, 0);
        double sum = 0;
        const int n = 1 << 14;
        for (int s = 0; s < n; ++s) sum += sky.towards(cosine_direction(normal, Sampler(4, 0, 0, s).square(0))).x / n;
        CHECK(sky.mean(normal).x == Approx(sum).margin(2e-3));
        ++cases;
    }
    CHECK(cases == 5);
}

TEST_CASE("A checker has one colour on a face that lies between its cubes") {
    Texture checker;
    checker.kind = Texture::Kind::checker;
    checker.scale = 0.5;
    int black = 0, white = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec2 u = Sampler(6, 0, 0, i).square(0);
        const Vec3 x(0.5 * u.x, 1e-7 * (i % 7 - 3.0), 0.5 * u.y);  // slightly above and below the face
        const bool a = color_at(checker, x, {0, 1, 0}) == checker.a;
        (a ? white : black) += 1;
        // Half a unit along x or y the colour is the other one; half a unit along both x and z it is the same.
        CHECK((color_at(checker, x + Vec3(0.5, 0, 0), {0, 1, 0}) == checker.a) != a);
        CHECK((color_at(checker, x + Vec3(0, 0.5, 0), {0, 1, 0}) == checker.a) != a);
        CHECK((color_at(checker, x - Vec3(0.5, 0, 0.5), {0, 1, 0}) == checker.a) == a);
    }
    CHECK(std::min(black, white) == 0);
}

TEST_CASE("Noise is bounded, continuous and not constant; wood lies between its colours") {
    Texture wood;
    wood.kind = Texture::Kind::wood;
    wood.a = {0.6, 0.4, 0.2};
    wood.b = {0.3, 0.15, 0.05};
    wood.axis = {1, 2, 0.5};
    wood.scale = 0.1;
    double lowest = 0, highest = 0;
    for (int i = 0; i < 100'000; ++i) {
        const Vec2 u = Sampler(7, 0, 0, i).square(0), v = Sampler(7, 0, 0, i).square(1);
        const Vec3 x = 40.0 * Vec3(u.x, u.y, v.x) - 20.0;
        const double here = noise(x);
        lowest = std::min(lowest, here);
        highest = std::max(highest, here);
        CHECK(std::abs(noise(x + Vec3(1e-7)) - here) < 1e-6);
        const Vec3 c = color_at(wood, x, {0, 1, 0});
        for (int k = 0; k < 3; ++k) CHECK((c[k] <= wood.a[k] + 1e-12 && c[k] >= 0.5 * wood.b[k]));
    }
    CHECK(lowest < -0.6);
    CHECK(highest > 0.6);
    CHECK(lowest >= -1);
    CHECK(highest <= 1);
    CHECK(noise({3, -4, 5}) == 0);
}

namespace {

// The radiance is 1 + x/2 + y² in direction (x, y, z), which consists of spherical harmonics up to the second band.
Background pictured(double rotate = 0) {
    PictureData s{256, 128, {}};
    for (int j = 0; j < s.height; ++j)
        for (int i = 0; i < s.width; ++i) {
            const double phi = 2 * pi * ((i + 0.5) / s.width - 0.5), theta = pi * (j + 0.5) / s.height;
            const Vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            for (int k = 0; k < 3; ++k) s.rgb.push_back(float(1 + 0.5 * d.x + d.y * d.y));
        }
    Background background;
    background.file = "made here";
    background.picture = std::make_shared<const PictureData>(std::move(s));
    background.rotate = rotate;
    return background;
}

// Irradiance/π in that environment: the cosine scales the bands by 1, 2/3 and 1/4, and y² is 1/3 plus 2/3 of a
// second-band harmonic.
double pictured_mean(Vec3 n) { return 1 + 0.5 * 2 / 3 * n.x + 1.0 / 3 + 0.25 * 2 / 3 * (1.5 * n.y * n.y - 0.5); }

}  // namespace

TEST_CASE("A picture around the scene has its irradiance by spherical harmonics, in previews and by paths") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    const AnalyticTracer sphere({{AnalyticShape::Kind::sphere, Vec3(0.0), {}, 1, 0}});
    int cases = 0;
    for (double rotate : {0.0, 90.0})
        for (Vec3 n : {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), glm::normalize(Vec3(1, -2, 0.5))}) {
            scene.background = pictured(rotate);
            const SkyLight sky(scene.background);
            // A rotation by 90° about y moves what was at x to −z.
            const double expected = pictured_mean(rotate == 0 ? n : Vec3(-n.z, n.y, n.x));
            CAPTURE(rotate, n.x, n.y, n.z);
            CHECK(sky.mean(n).x == Approx(expected).epsilon(1e-3));
            scene.camera = {4.0 * n, Vec3(0.0), std::abs(n.y) > 0.9 ? Vec3(0, 0, 1) : Vec3(0, 1, 0), 1e-7};
            CHECK(pixel_of(scene, sphere, 1).color.x == Approx(expected).epsilon(1e-3));
            CHECK(pixel_of(scene, sphere, 4096).color.x == Approx(expected).epsilon(3e-3));
            ++cases;
        }
    CHECK(cases == 8);
}

TEST_CASE("Directions are sampled by brightness with the density that is claimed") {
    for (const Background& background : {pictured(30), [] {
                                             Background day;
                                             day.sun = {1, 0.5, 0.3};
                                             return day;
                                         }()}) {
        const SkyLight sky(background);
        const auto observable = [](Vec3 d) { return (1 + 0.5 * d.x) * (1.5 + d.y) * (1.2 + d.z); };
        double exact = 0, sampled = 0, all = 0;
        const int rows = 512, columns = 512, n = 1 << 15;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                const double y = 1 - 2 * (j + 0.5) / rows, r = std::sqrt(1 - y * y), phi = 2 * pi * (i + 0.5) / columns;
                const Vec3 d(r * std::cos(phi), y, r * std::sin(phi));
                const double share = sky.density(d) * 4 * pi / (rows * columns);
                all += share;
                exact += observable(d) * share;
            }
        for (int s = 0; s < n; ++s) {
            const Vec3 d = sky.sample(Sampler(5, 0, 0, s).square(0));
            CHECK(std::abs(glm::length(d) - 1) < 1e-12);
            sampled += observable(d) / n;
        }
        CHECK(all == Approx(1).epsilon(2e-3));
        CHECK(sampled == Approx(exact).epsilon(2e-3));
    }
}

TEST_CASE("By day, a floor in the open gets the sun's light and the sky's") {
    Scene scene = ground_under({});
    scene.lights.clear();
    scene.background.sun = {0.5, 1, 0.2};
    const SkyLight sky(scene.background);
    const double expected = sky.mean({0, 1, 0}).x + sky.sun().irradiance().x * sky.sun().direction.y / pi;
    CHECK(pixel_of(scene, AnalyticTracer({floor_at(0)}), 4096).color.x == Approx(expected).epsilon(0.01));
    CHECK(pixel_of(scene, AnalyticTracer({floor_at(0)}), 1).color.x == Approx(expected).epsilon(1e-6));
    CHECK(sky.sun().irradiance().x > 2);
    CHECK(sky.sun().irradiance().z < sky.sun().irradiance().x);
    // A low sun is weak and red; below the horizon it does not shine.
    scene.background.sun = {1, 0.05, 0};
    const Vec3 evening = SkyLight(scene.background).sun().irradiance();
    CHECK(evening.x < 0.5 * sky.sun().irradiance().x);
    CHECK(evening.z < 0.3 * evening.x);
    scene.background.sun = {1, -0.1, 0};
    CHECK_FALSE(SkyLight(scene.background).sun().shines());
}
