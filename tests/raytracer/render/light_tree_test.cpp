// A thousand lights: sampling by importance and intersection with rays, against a loop over all lights.
#include "raytracer/render/light_tree.hpp"

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"
#include "raytracer/render/emitters.hpp"

using namespace deburr;

namespace {

double random(int i, int k) { return Sampler(9, i, 0, 0).line(std::uint32_t(k)); }
Vec3 random_point(int i, int k) { return {20 * random(i, k) - 10, 4 * random(i, k + 1), 20 * random(i, k + 2) - 10}; }

// Point, sphere and area lights of any orientation in a hall.
std::vector<Light> hall(int count, bool visible) {
    std::vector<Light> lights;
    for (int i = 0; i < count; ++i) {
        Light light;
        light.kind = i % 3 == 0 ? Light::Kind::point : i % 3 == 1 ? Light::Kind::sphere : Light::Kind::area;
        light.position = random_point(i, 0);
        light.radius = 0.05;
        light.u = 0.1 * (random_point(i, 3) - random_point(i, 6));
        light.v = 0.1 * (random_point(i, 9) - random_point(i, 12));
        light.power = random(i, 20) * random(i, 21);
        light.visible = visible;
        lights.push_back(light);
    }
    return lights;
}

double brightness(Vec3 c) { return (c.x + c.y + c.z) / 3; }

}  // namespace

TEST_CASE("Probabilities of all lights are at most 1 together, and a light is chosen as often as its own says") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(0.8)));
    scene.lights = hall(300, true);
    scene.lights[7].power = 0;
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.power = 0.5;
    scene.lights.push_back(sun);
    const SkyLight sky(scene.background);
    const Emitters emitters(scene, sky);
    for (int k = 0; k < 40; ++k) {
        const Vec3 point = k < 30 ? random_point(k, 50) : scene.lights[k].position + Vec3(0.01, 0, 0);
        const double all = emitters.importance(point);
        double sum = 0;
        for (std::size_t i = 0; i < emitters.size(); ++i) {
            const double part = emitters.importance(i, point);
            sum += part;
            // A light's probability may be 0 only where no light arrives from it.
            if (brightness(emitters.at(i, point, Vec2(0.5)).irradiance) > 0) CHECK(part > 0);
        }
        // The sum may be less than `all`, since a node's bound may be positive where those of both its halves are 0.
        CHECK(sum < all * (1 + 1e-9));
        CHECK(sum > 0.98 * all);
    }
    const Vec3 point(1, 0, 2);
    const double all = emitters.importance(point);
    std::vector<int> chosen(emitters.size());
    const int draws = 1 << 18;
    double none = 1;
    for (std::size_t i = 0; i < emitters.size(); ++i) none -= emitters.importance(i, point) / all;
    int lost = 0;
    for (int s = 0; s < draws; ++s) {
        const auto found = emitters.choose(point, all, (s + 0.5) / draws);
        ++(found ? chosen[*found] : lost);
    }
    CHECK(lost == Approx(draws * none).margin(40));
    for (std::size_t i = 0; i < emitters.size(); ++i)
        CHECK(chosen[i] == Approx(draws * emitters.importance(i, point) / all).margin(40));
    CHECK(chosen.back() > 0);  // the sun
    CHECK(chosen[7] == 0);
}

TEST_CASE("A ray meets the same of a thousand lights as of a list") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(0.8)));
    scene.lights = hall(1000, true);
    const SkyLight sky(scene.background);
    const Emitters emitters(scene, sky);
    int met = 0;
    for (int k = 0; k < 20'000; ++k) {
        const Vec3 from = random_point(k, 70);
        Vec3 to = random_point(k, 80);
        if (k % 4 == 0) to = scene.lights[k / 4 % 1000].position;
        if (k % 5 == 0) to.y = from.y;
        const Ray ray{from, glm::normalize(to - from)};
        double nearest = infinity;
        std::size_t which = 0;
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            const double t = LightSource(scene.lights[i]).seen(ray, 30).t;
            if (t < nearest) {
                nearest = t;
                which = i;
            }
        }
        const Emitters::Met found = emitters.met(ray, 30);
        REQUIRE(found.t == nearest);
        if (nearest < infinity) REQUIRE(found.emitter == which);
        REQUIRE(emitters.hidden(ray, 30, scene.lights.size()) == (nearest < infinity));
        met += nearest < infinity;
    }
    CHECK(met > 4000);
}

TEST_CASE("A thousand lights give what they give one by one, with far less noise than by power alone") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(0.8)));
    scene.lights = hall(1000, false);
    scene.camera.eye = {3, 3, 0};
    const SkyLight sky(scene.background);
    const Emitters emitters(scene, sky);

    // Variance of one sample for either set of probabilities, with the light of each light's center and no shadows.
    double by_tree = 0, by_power = 0, power = 0;
    for (const Light& light : scene.lights) power += light.power;
    for (int k = 0; k < 50; ++k) {
        const Vec3 point(20 * random(k, 90) - 10, 0, 20 * random(k, 91) - 10);
        const double all = emitters.importance(point);
        double sum = 0, squares_by_tree = 0, squares_by_power = 0;
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            const Emitters::Sample s = emitters.at(i, point, Vec2(0.5));
            const double light = brightness(s.irradiance) * std::max(0.0, s.direction.y);
            sum += light;
            if (light > 0) squares_by_tree += light * light * all / emitters.importance(i, point);
            if (light > 0) squares_by_power += light * light * power / scene.lights[i].power;
        }
        by_tree += squares_by_tree / (sum * sum) - 1;
        by_power += squares_by_power / (sum * sum) - 1;
    }
    CAPTURE(by_tree / 50, by_power / 50);
    CHECK(by_tree < 0.1 * by_power);

    const AnalyticTracer tracer({{AnalyticShape::Kind::plane, Vec3(0.0), {0, 1, 0}, 0, 0}});
    const auto value = [&](int spp) {
        TraceCounters counters;
        RenderSettings settings{1, 1, spp, 0};
        settings.integrator = IntegratorKind::path;
        return Integrator(scene, tracer, settings).pixel(0, 0, nullptr, counters).color.x;
    };
    const double together = value(1 << 16);
    double sum = 0;
    const std::vector<Light> all = scene.lights;
    for (const Light& light : all) {
        scene.lights = {light};
        sum += value(64);
    }
    CHECK(together == Approx(sum).epsilon(0.005));
}
