// Shading with one and many samples: materials, layers, shadows and robustness.
#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"

using namespace deburr;

namespace {

const AnalyticShape ground = floor_at(-1, 1);

// A sphere of each material on a checkered plane, lit by every kind of light under a sky.
struct Zoo {
    Scene scene;
    std::vector<AnalyticShape> shapes;

    Zoo() {
        using Kind = Material::Kind;
        scene.materials = {
            material_of(Kind::matte, {0.8, 0.3, 0.2}),      material_of(Kind::matte, Vec3(0.5)),
            material_of(Kind::plastic, {0.1, 0.4, 0.8}),    material_of(Kind::plastic, {0.1, 0.4, 0.8}, 0.0),
            material_of(Kind::metal, {0.9, 0.7, 0.3}, 0.1), material_of(Kind::metal, {0.9, 0.7, 0.3}, 0.6),
            material_of(Kind::mirror, Vec3(0.9)),           material_of(Kind::glass, {0.9, 1, 0.9}, 0.0),
            material_of(Kind::glass, Vec3(1.0), 0.4)};
        scene.materials[1].color.kind = Texture::Kind::checker;
        shapes = {ground};
        for (int i = 0; i < 9; ++i)
            shapes.push_back({AnalyticShape::Kind::sphere, {2.2 * (i % 3) - 2.2, 0, 2.2 * (i / 3) - 2.2}, {}, 1, i});
        scene.camera = {{0, 6, 9}, {0, 0, 0}, {0, 1, 0}, 40};
        scene.background.sky = true;
        scene.ambient = Vec3(0.05);
        Light point, sun, panel;
        point.position = {3, 6, 4};
        point.power = 300;
        sun.kind = Light::Kind::directional;
        sun.direction = glm::normalize(Vec3(1, -2, -1));
        panel.kind = Light::Kind::area;
        panel.position = {-3, 5, 0};
        panel.u = {2, 0, 0};
        panel.v = {0, 0, 2};
        panel.power = 100;
        panel.samples = 2;
        scene.lights = {point, sun, panel};
    }
};

struct Seen {
    Pixel pixel;
    PixelLayers layers;
};

Seen seen(const Integrator& integrator, int x, int y, TraceCounters& counters) {
    Seen s;
    s.pixel = integrator.pixel(x, y, &s.layers, counters);
    return s;
}

bool same(const Pixel& a, const Pixel& b) { return a.color == b.color && a.alpha == b.alpha; }

bool same(const PixelLayers& a, const PixelLayers& b) {
    return a.position == b.position && a.normal == b.normal && a.z == b.z && a.albedo == b.albedo &&
           a.guide_normal == b.guide_normal && a.id == b.id && a.cost == b.cost;
}

bool same(const Seen& a, const Seen& b) { return same(a.pixel, b.pixel) && same(a.layers, b.layers); }

bool finite(const Seen& s) {
    double sum = s.pixel.alpha + s.layers.cost;
    for (Vec3 v : {s.pixel.color, s.layers.position, s.layers.normal, s.layers.albedo, s.layers.guide_normal})
        sum += v.x + v.y + v.z;
    return std::isfinite(sum) && !std::isnan(s.layers.z);
}

}  // namespace

TEST_CASE("White spheres vanish in a white world in a preview") {
    using Kind = Material::Kind;
    int cases = 0;
    for (auto kind : {Kind::matte, Kind::plastic, Kind::metal, Kind::mirror, Kind::glass})
        for (double roughness : {0.0, 0.2, 0.5}) {
            CAPTURE(int(kind), roughness);
            Scene scene = probe(material_of(kind, Vec3(1.0), roughness));
            scene.background.color = Vec3(1.0);
            scene.camera.eye = {0.8, 4, 0};
            scene.camera.target = {0.8, 0, 0};
            scene.bounces = 20;
            const Pixel p = pixel_of(scene, AnalyticTracer({unit_sphere}), 1);
            CHECK(close(p.color, Vec3(1.0), 0.004));
            CHECK(p.alpha == 1);
            ++cases;
        }
    CHECK(cases == 15);
}

TEST_CASE("A preview of many samples is free of noise, too") {
    Scene scene = probe(material_of(Material::Kind::plastic, {0.8, 0.3, 0.2}));
    scene.background.sky = true;
    const AnalyticTracer tracer({unit_sphere});
    TraceCounters counters;
    const auto preview = [&](int spp, std::uint64_t seed) {
        RenderSettings settings{1, 1, spp, seed};
        settings.integrator = IntegratorKind::preview;
        return Integrator(scene, tracer, settings).pixel(0, 0, nullptr, counters).color;
    };
    CHECK(close(preview(16, 0), preview(1, 0), 1e-6));
    CHECK(close(preview(16, 1), preview(16, 2), 1e-6));
}

TEST_CASE("A mirror shows what is behind the eye, tinted") {
    Scene scene = probe(material_of(Material::Kind::mirror, {0.5, 1, 1}));
    scene.materials.push_back(material_of(Material::Kind::matte, Vec3(1.0)));
    scene.ambient = {1, 2, 3};
    scene.camera.eye = {-3, 3, 0};  // at 45°: the mirrored ray passes through (3, 3, 0)
    const AnalyticShape floor{AnalyticShape::Kind::plane, Vec3(0.0), {0, 1, 0}, 0, 0};
    const AnalyticShape ball{AnalyticShape::Kind::sphere, {3, 3, 0}, {}, 0.01, 1};
    for (int spp : {1, 16}) {
        // With path tracing the ball's lower side looks into the mirror, which reflects no ambient light.
        if (spp == 1) CHECK(close(pixel_of(scene, AnalyticTracer({floor, ball}), spp).color, {0.5, 2, 3}, 1e-9));
        CHECK(close(pixel_of(scene, AnalyticTracer({floor}), spp).color, Vec3(0.0), 1e-9));
    }
}

TEST_CASE("A plate of glass shifts a ray sideways as Snell says") {
    // A ray enters a plate of thickness 1 and index 1.5 at 45° and leaves it parallel to itself, but shifted.
    Scene scene = probe(material_of(Material::Kind::glass, Vec3(1.0), 0.0));
    scene.materials.push_back(material_of(Material::Kind::matte, Vec3(1.0)));
    scene.ambient = Vec3(1.0);
    scene.camera.eye = {-3, 3, 0};
    const AnalyticShape plate{AnalyticShape::Kind::slab, Vec3(0.0), {0, 1, 0}, 1, 0};
    const double sine = std::sqrt(0.5) / 1.5, inside = sine / std::sqrt(1 - sine * sine);
    auto ball_at = [&](double x) { return AnalyticShape{AnalyticShape::Kind::sphere, {x, -2, 0}, {}, 0.02, 1}; };
    const double through = std::pow(1 - fresnel_dielectric(std::sqrt(0.5), 1.5), 2);
    const AnalyticTracer met({plate, ball_at(inside + 1)}), missed({plate, ball_at(2)});
    CHECK(pixel_of(scene, met, 1).color.x == Approx(through).epsilon(1e-6));
    CHECK(pixel_of(scene, missed, 1).color.x == 0);
    CHECK(pixel_of(scene, met, 4096).color.x == Approx(through).epsilon(0.01));
}

TEST_CASE("Glass lets light pass straight on, weaker; everything else casts a shadow") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    scene.materials.push_back(material_of(Material::Kind::glass, {0.5, 1, 1}, 0.0));
    scene.materials.push_back(material_of(Material::Kind::metal, Vec3(1.0)));
    Light light;
    light.position = {0, 10, 0};
    light.power = 400 * pi * pi;
    scene.lights = {light};
    const AnalyticShape floor{AnalyticShape::Kind::plane, Vec3(0.0), {0, 1, 0}, 0, 0};
    scene.camera.eye = {4, 4, 0};
    AnalyticShape ball{AnalyticShape::Kind::sphere, {0, 6, 0}, {}, 1, 1};
    const double open = pixel_of(scene, AnalyticTracer({floor}), 1).color.x;
    CHECK(open == Approx(1).epsilon(1e-9));
    const Vec3 tinted = pixel_of(scene, AnalyticTracer({floor, ball}), 1).color;
    CHECK(close(tinted, Vec3(0.25, 1, 1) * 0.96 * 0.96, 1e-6));
    ball.material = 2;
    CHECK(close(pixel_of(scene, AnalyticTracer({floor, ball}), 1).color, Vec3(0.0), 0));
}

TEST_CASE("In the open one sample agrees with many") {
    Scene scene = probe(material_of(Material::Kind::matte, {0.8, 0.3, 0.2}));
    scene.background.sky = true;
    scene.ambient = Vec3(0.1);
    Light light;
    light.position = {1, 4, 2};
    light.power = 100;
    scene.lights = {light};
    const AnalyticTracer tracer({unit_sphere});
    int cases = 0;
    for (double x : {0.0, 0.5, 0.9}) {
        scene.camera.eye = {x, 4, 0};
        scene.camera.target = {x, 0, 0};
        CHECK(close(pixel_of(scene, tracer, 1).color, pixel_of(scene, tracer, 1024).color, 0.004));
        ++cases;
    }
    CHECK(cases == 3);
}

TEST_CASE("With one sample matte and plastic cost a camera ray and a shadow ray a light") {
    for (auto kind : {Material::Kind::matte, Material::Kind::plastic}) {
        Scene scene = probe(material_of(kind, Vec3(0.8)));
        scene.background.sky = true;
        Light light;
        light.position = {0, 5, 0};
        scene.lights = {light, light};
        TraceCounters counters;
        const AnalyticTracer tracer({unit_sphere});
        const Seen s = seen(Integrator(scene, tracer, {1, 1, 1, 0}), 0, 0, counters);
        CHECK(counters.rays == 1);
        CHECK(counters.shadow_rays == 2);
        CHECK(s.layers.cost == 3);
    }
}

TEST_CASE("Layers are those of the ray through the pixel's centre at any number of samples") {
    const Zoo zoo;
    const AnalyticTracer tracer(zoo.shapes);
    const int width = 24, height = 16;
    const ProjectiveCamera camera(zoo.scene.camera, width, height);
    int hits = 0;
    for (int spp : {1, 4}) {
        const Integrator integrator(zoo.scene, tracer, {width, height, spp, 0});
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                TraceCounters counters;
                const auto [pixel, p] = seen(integrator, x, y, counters);
                const Hit hit = tracer.closest_hit(camera.ray(x + 0.5, y + 0.5), infinity, counters);
                CHECK(p.id == std::uint32_t(hit.solid + 1));
                if (!hit) {
                    CHECK(p.z == infinity);
                    continue;
                }
                ++hits;
                CHECK(p.position == hit.position);
                CHECK(p.normal == hit.normal);
                CHECK(p.z == Approx(glm::dot(hit.position - camera.eye(), camera.forward())));
                if (spp == 1) CHECK(pixel.alpha == 1);
            }
    }
    CHECK(hits > 300);
}

TEST_CASE("A pixel depends on its place and the seed, not on what was rendered before") {
    const Zoo zoo;
    const AnalyticTracer tracer(zoo.shapes);
    const Integrator a(zoo.scene, tracer, {24, 16, 3, 9}), b(zoo.scene, tracer, {24, 16, 3, 9}),
        other(zoo.scene, tracer, {24, 16, 3, 10});
    TraceCounters counters, used;
    int changed = 0;
    for (int i = 0; i < 24 * 16; ++i) {
        const int x = i % 24, y = i / 24;
        const Seen p = seen(a, x, y, counters);
        seen(b, 23 - x, 15 - y, used);
        CHECK(same(p, seen(b, x, y, used)));
        changed += !same(p, seen(other, x, y, counters));
    }
    CHECK(changed > 300);
}

TEST_CASE("A pixel is the same without layers, and then asks for no ray that only they need") {
    const Zoo zoo;
    const AnalyticTracer tracer(zoo.shapes);
    for (int spp : {1, 3}) {
        const Integrator integrator(zoo.scene, tracer, {24, 16, spp, 9});
        TraceCounters with, without;
        for (int i = 0; i < 24 * 16; ++i)
            CHECK(
                same(seen(integrator, i % 24, i / 24, with).pixel, integrator.pixel(i % 24, i / 24, nullptr, without)));
        CHECK(with.rays - without.rays == (spp == 1 ? 0 : 24 * 16));
        CHECK(with.shadow_rays == without.shadow_rays);
    }
}

TEST_CASE("A block is its pixels, row by row") {
    const Zoo zoo;
    const AnalyticTracer tracer(zoo.shapes);
    const Window block{5, 3, 16, 11};
    for (int spp : {1, 3}) {
        const Integrator integrator(zoo.scene, tracer, {24, 16, spp, 9});
        std::vector<Pixel> pixels(16 * 11);
        std::vector<PixelLayers> layers(pixels.size());
        TraceCounters together, single;
        integrator.block(block, pixels.data(), layers.data(), together);
        for (int i = 0; i < 16 * 11; ++i)
            CHECK(same({pixels[i], layers[i]}, seen(integrator, 5 + i % 16, 3 + i / 16, single)));
        CHECK(together.rays == single.rays);
        CHECK(together.shadow_rays == single.shadow_rays);
        CHECK(together.evaluations == single.evaluations);
    }
}

TEST_CASE("No pixel holds a NaN, wherever the camera and the lights are") {
    Zoo zoo;
    int pixels = 0, lit = 0;
    Light degenerate;
    degenerate.kind = Light::Kind::area;
    degenerate.u = degenerate.v = {1, 0, 0};
    zoo.scene.lights.push_back(degenerate);
    degenerate.kind = Light::Kind::directional;
    degenerate.direction = Vec3(0.0);
    zoo.scene.lights.push_back(degenerate);
    for (Vec3 eye : {Vec3(0, 6, 9), Vec3(-2.2, 0, -2.2), Vec3(0, -0.999999, 20), Vec3(0, -3, 0), Vec3(0, 0, 2.2),
                     Vec3(2.2, 0, 2.2), Vec3(0.0)})
        for (int spp : {1, 4}) {
            zoo.scene.camera.eye = eye;
            zoo.scene.lights[0].position = eye;
            const AnalyticTracer tracer(zoo.shapes);
            const Integrator integrator(zoo.scene, tracer, {20, 14, spp, 0});
            for (int i = 0; i < 20 * 14; ++i) {
                TraceCounters counters;
                const Seen s = seen(integrator, i % 20, i / 20, counters);
                const Pixel& p = s.pixel;
                CHECK(finite(s));
                CHECK(min_component(p.color) >= 0);
                lit += p.color.x > 0.02;
                ++pixels;
            }
        }
    CHECK(pixels == 7 * 2 * 280);
    CHECK(lit > pixels / 2);
}

TEST_CASE("A tracer that returns nonsense does not spread it") {
    struct Broken final : RayTracer {
        Hit closest_hit(const Ray&, double, TraceCounters&) const override {
            Hit hit;
            hit.t = 1;
            hit.solid = 0;
            hit.normal = hit.position = Vec3(std::nan(""));
            return hit;
        }
        bool any_hit(const Ray&, double, TraceCounters&) const override { return false; }
    } broken;
    Zoo zoo;
    for (int m = 0; m < 9; ++m) {
        std::swap(zoo.scene.materials[0], zoo.scene.materials[m]);
        TraceCounters counters;
        for (int spp : {1, 4}) CHECK(finite(seen(Integrator(zoo.scene, broken, {1, 1, spp, 0}), 0, 0, counters)));
    }
}

TEST_CASE("Matte surfaces are lit on the side that is seen") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    Light light;
    light.power = 4 * pi * pi;  // at the sphere's center: irradiance π everywhere inside
    scene.lights = {light};
    scene.camera = {{0, 0.5, 0}, {0, -1, 0}, {0, 0, 1}, 1e-7};
    CHECK(close(pixel_of(scene, AnalyticTracer({unit_sphere}), 1).color, Vec3(1.0), 1e-9));
}

TEST_CASE("An area light is seen in a mirror and in glass, from its front; and not by the camera if it is invisible") {
    Scene scene = probe(material_of(Material::Kind::mirror, Vec3(0.5)));
    scene.materials.push_back(material_of(Material::Kind::glass, Vec3(1.0), 0.0));
    Light panel;
    panel.kind = Light::Kind::area;
    panel.position = {0, 8, 0};
    panel.u = {2, 0, 0};
    panel.v = {0, 0, 2};
    panel.power = 12 * pi;  // radiance 3
    panel.visible = false;
    scene.lights = {panel};
    AnalyticShape floor{AnalyticShape::Kind::plane, Vec3(0.0), {0, 1, 0}, 0, 0};
    const AnalyticTracer nothing({});
    for (int spp : {1, 16}) {
        floor.material = 0;
        CHECK(close(pixel_of(scene, AnalyticTracer({floor}), spp).color, Vec3(1.5), 1e-9));
        floor.material = 1;
        CHECK(close(pixel_of(scene, AnalyticTracer({floor}), spp).color, Vec3(0.12), 1e-9));
        std::swap(scene.lights[0].u, scene.lights[0].v);
        CHECK(close(pixel_of(scene, AnalyticTracer({floor}), spp).color, Vec3(0.0), 0));
        std::swap(scene.lights[0].u, scene.lights[0].v);
        scene.lights[0].position.y = 2;  // between the eye and the floor
        CHECK(close(pixel_of(scene, nothing, spp).color, Vec3(0.0), 0));
        scene.lights[0].position.y = 8;
    }
}

TEST_CASE("A wall hides half of the sky from its foot, and gives some of it back") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(0.5)));
    scene.materials.push_back(material_of(Material::Kind::matte, Vec3(0.25)));
    scene.background.color = Vec3(1.0);
    const AnalyticShape floor{AnalyticShape::Kind::plane, Vec3(0.0), {0, 1, 0}, 0, 0};
    const AnalyticShape wall{AnalyticShape::Kind::plane, {-1e-6, 0, 0}, {1, 0, 0}, 0, 1};
    const AnalyticTracer corner({floor, wall});
    // Floor and wall each see the other in half of their hemisphere: floor = 0.5·(1 + wall)/2, wall = 0.25·(1 +
    // floor)/2.
    CHECK(close(pixel_of(scene, corner, 1 << 14).color, Vec3(0.25 * 1.125 / 0.96875), 1e-3));
    CHECK(close(pixel_of(scene, corner, 1).color, Vec3(0.5), 1e-9));
}
