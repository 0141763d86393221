// The path integrator against closed forms and against plain paths without its sampling of lights.
#include "raytracer/render/path_integrator.hpp"

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"
#include "raytracer/render/closed_forms.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

namespace {

Pixel path_pixel(const Scene& scene, const RayTracer& tracer, int spp, std::uint64_t seed = 0) {
    TraceCounters counters;
    RenderSettings settings{1, 1, spp, seed};
    settings.integrator = IntegratorKind::path;
    return Integrator(scene, tracer, settings).pixel(0, 0, nullptr, counters);
}

Light sphere_light(Vec3 position, double radius, double radiance) {
    Light light;
    light.kind = Light::Kind::sphere;
    light.position = position;
    light.radius = radius;
    light.power = radiance * 4 * pi * pi * radius * radius;
    return light;
}

Light panel_light(Vec3 position, Vec3 u, Vec3 v, double radiance) {
    Light light;
    light.kind = Light::Kind::area;
    light.position = position;
    light.u = u;
    light.v = v;
    light.power = radiance * pi * glm::length(glm::cross(u, v));
    return light;
}

}  // namespace

TEST_CASE("White spheres vanish in a white world, whatever they are made of", "[slow]") {
    using Kind = Material::Kind;
    int cases = 0;
    for (auto kind : {Kind::matte, Kind::plastic, Kind::metal, Kind::mirror, Kind::glass, Kind::pbr})
        for (double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
            CAPTURE(int(kind), roughness);
            Material material = material_of(kind, Vec3(1.0), roughness);
            if (kind == Kind::pbr) material.transmission = material.clearcoat = 0.5;
            Scene scene = probe(material);
            scene.background.color = Vec3(1.0);
            scene.camera.eye = {0.8, 4, 0};
            scene.camera.target = {0.8, 0, 0};
            Pixel p;
            // Takes more samples as long as the deviation might be noise.
            for (int spp = 1 << 16; spp <= 1 << 20; spp *= 4) {
                p = path_pixel(scene, AnalyticTracer({unit_sphere}), spp);
                if (std::abs(p.color.x - 1) < 8e-4) break;
            }
            CHECK(p.color.x == Approx(1).margin(1e-3));
            CHECK(p.alpha == 1);
            ++cases;
        }
    CHECK(cases == 30);
}

TEST_CASE("A sphere light gives a plane what its solid angle says") {
    // The irradiance is π L (R/d)² cos θ where the whole light is above the horizon.
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    for (const auto& [position, radius] :
         {std::pair{Vec3(0, 3, 0), 1.0}, {Vec3(2, 2, 1), 0.3}, {Vec3(0, 1.2, 0), 1.0}, {Vec3(0, 40, 30), 0.001}}) {
        scene.lights = {sphere_light(position, radius, 5)};
        scene.lights[0].visible = false;  // so that the camera looks through it
        const double d = glm::length(position);
        const double expected = 5 * radius * radius / (d * d) * position.y / d;
        CHECK(path_pixel(scene, AnalyticTracer({floor_at(0)}), 4096).color.x == Approx(expected).epsilon(0.003));
    }
}

TEST_CASE("A light is seen by the camera, hides what is behind it, and shadows another light") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    const AnalyticTracer tracer({floor_at(0)});
    scene.background.color = Vec3(0.25);
    scene.lights = {panel_light({0, 2, 0}, {0, 0, 1}, {1, 0, 0}, 3)};  // u × v points up, to the camera
    CHECK(close(path_pixel(scene, tracer, 16).color, Vec3(3.0), 1e-9));
    CHECK(path_pixel(scene, tracer, 16).alpha == 1);
    std::swap(scene.lights[0].u, scene.lights[0].v);  // the camera sees its back
    CHECK(close(path_pixel(scene, tracer, 16).color, Vec3(0.0), 0));
    scene.lights = {sphere_light({0, 2, 0}, 0.5, 7)};
    CHECK(close(path_pixel(scene, tracer, 16).color, Vec3(7.0), 1e-9));

    // Seen from the side, a panel's black back is in front of a sphere light straight above the point.
    scene.camera.eye = {4, 4, 0};
    scene.background.color = Vec3(0.0);
    scene.lights = {sphere_light({0, 4, 0}, 0.2, 7), panel_light({0, 2, 0}, {0, 0, 1}, {1, 0, 0}, 0)};
    CHECK(close(path_pixel(scene, tracer, 64).color, Vec3(0.0), 0));
    scene.lights[1].visible = false;
    CHECK(path_pixel(scene, tracer, 1024).color.x == Approx(7 * 0.0025).epsilon(0.01));
}

TEST_CASE("Two squares exchange light by their form factor") {
    // The form factor of parallel unit squares at distance 1 is 0.1998 [Howell's catalogue, C-11].
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    const AnalyticTracer tracer({floor_at(0)});
    double sum = 0;
    const int n = 16;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const Vec3 point((i + 0.5) / n - 0.5, 0, (k + 0.5) / n - 0.5);
            scene.camera.eye = point + Vec3(3, 0.5, 0);
            scene.camera.target = point;
            scene.camera.up = {0, 1, 0};
            scene.lights = {panel_light({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 1)};
            sum += path_pixel(scene, tracer, 256).color.x / (n * n);
        }
    CHECK(sum == Approx(0.1998).epsilon(0.004));
}

TEST_CASE("A glowing solid is sampled through the ball around it, and met by reflections") {
    // From the floor below a glowing box only its bottom is seen.
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(1.0)));
    scene.camera.eye = {3, 0.7, 0};
    Material lamp = material_of(Material::Kind::matte, Vec3(0.0));
    lamp.emission = Vec3(4.0);
    scene.materials.push_back(lamp);
    scene.solids = {Solid::sharp(Density::half_space({0, 1, 0}, 0)).material(0),
                    Solid::sharp(Density::box({-0.5, 1, -1}, {0.5, 1.3, 1})).material(1)};
    const ImplicitTracer tracer(scene.solids);
    const double expected = 4 * 4 * corner_form_factor(0.5, 1);
    CHECK(path_pixel(scene, tracer, 1 << 14).color.x == Approx(expected).epsilon(0.004));
    const SkyLight sky(scene.background);
    REQUIRE(Emitters(scene, sky).size() == 1);
    // A mirror shows the lamp's radiance itself.
    scene.materials[0] = material_of(Material::Kind::mirror, Vec3(0.5));
    scene.camera.eye = {2, 2, 0};
    CHECK(close(path_pixel(scene, tracer, 4).color, Vec3(0.0), 0));
    scene.camera.eye = {0.1, 2, 0};
    scene.camera.target = {0.1, 0, 0};
    scene.camera.up = {0, 0, 1};
    CHECK(path_pixel(scene, tracer, 4).color.x == 4);  // its top
}

TEST_CASE("The mean does not depend on the number of samples", "[slow]") {
    using Kind = Material::Kind;
    Scene scene = probe(material_of(Kind::plastic, {0.7, 0.5, 0.3}, 0.3));
    scene.materials.push_back(material_of(Kind::glass, Vec3(1.0), 0.3));
    scene.materials.push_back(material_of(Kind::metal, Vec3(0.9), 0.4));
    scene.background.sky = true;
    scene.lights = {panel_light({2, 4, 0}, {1, 0, 0}, {0, 0, 1}, 10), sphere_light({-3, 3, 1}, 0.5, 5)};
    scene.lights[0].samples = 3;
    scene.camera.eye = {3, 3, 2};
    const AnalyticTracer tracer({floor_at(0),
                                 {AnalyticShape::Kind::sphere, {-1.5, 1, 0}, {}, 1, 1},
                                 {AnalyticShape::Kind::sphere, {0.5, 1, -1.6}, {}, 1, 2}});
    const int total = 1 << 19;
    const Vec3 all = path_pixel(scene, tracer, total).color;
    int cases = 0;
    for (int spp = 1; spp <= 256; spp *= 4) {
        // All pixels of this picture look at the same point.
        const int pixels = total / spp;
        RenderSettings settings{pixels, 1, spp, 1};
        settings.integrator = IntegratorKind::path;
        const Integrator integrator(scene, tracer, settings);
        TraceCounters counters;
        Vec3 sum(0.0);
        for (int x = 0; x < pixels; ++x) sum += integrator.pixel(x, 0, nullptr, counters).color / double(pixels);
        CAPTURE(spp);
        for (int k = 0; k < 3; ++k) CHECK(sum[k] == Approx(all[k]).epsilon(0.003));
        ++cases;
    }
    CHECK(cases == 5);
}

TEST_CASE("Many lights give what they give one by one") {
    Scene scene = probe(material_of(Material::Kind::matte, Vec3(0.8)));
    const AnalyticTracer tracer({floor_at(0)});
    scene.camera.eye = {3, 3, 0};
    std::vector<Light> all;
    double sum = 0;
    for (int i = 0; i < 40; ++i) {
        const double angle = i * 2.4;
        all.push_back(sphere_light({i * 0.2 * std::cos(angle), 0.6 + 0.1 * i, i * 0.2 * std::sin(angle)}, 0.05, 9));
        all.back().visible = false;
        scene.lights = {all.back()};
        sum += path_pixel(scene, tracer, 64).color.x;
    }
    scene.lights = all;
    CHECK(path_pixel(scene, tracer, 1 << 14).color.x == Approx(sum).epsilon(0.01));
}

TEST_CASE("With a noise bound a pixel depends on neither the block nor the crop, and quiet parts end early") {
    Scene scene = probe(material_of(Material::Kind::plastic, Vec3(0.6), 0.3));
    scene.camera = {{0, 3, 6}, {0, 0, 0}, {0, 1, 0}, 50};
    scene.background.sky = true;
    scene.lights = {panel_light({2, 4, 0}, {1, 0, 0}, {0, 0, 1}, 10)};
    const AnalyticTracer tracer({floor_at(0), {AnalyticShape::Kind::sphere, {0, 1, 0}, {}, 1, 0}});
    RenderSettings settings{21, 13, 256, 3};
    settings.noise = 0.02;
    const Integrator integrator(scene, tracer, settings);
    std::vector<Pixel> whole(21 * 13), part(9 * 7);
    std::vector<PixelLayers> layers(whole.size());
    TraceCounters counters, exact, crop;
    integrator.block({0, 0, 21, 13}, whole.data(), nullptr, counters);
    integrator.block({5, 3, 9, 7}, part.data(), nullptr, crop);
    for (int i = 0; i < 9 * 7; ++i) {
        CHECK(part[i].color == whole[(3 + i / 9) * 21 + 5 + i % 9].color);
        CHECK(part[i].alpha == whole[(3 + i / 9) * 21 + 5 + i % 9].alpha);
    }
    TraceCounters with_layers;
    std::vector<Pixel> again(whole.size());
    integrator.block({0, 0, 21, 13}, again.data(), layers.data(), with_layers);
    for (std::size_t i = 0; i < whole.size(); ++i) CHECK(again[i].color == whole[i].color);
    // Against all samples in every pixel: the error is within the noise bound, with fewer rays.
    settings.noise = 0;
    std::vector<Pixel> all(whole.size());
    Integrator(scene, tracer, settings).block({0, 0, 21, 13}, all.data(), nullptr, exact);
    double sum = 0;
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (int k = 0; k < 3; ++k)
            sum +=
                std::pow(std::sqrt(whole[i].color[k]) - std::sqrt(all[i].color[k]), 2) / (3.0 * double(whole.size()));
    CHECK(std::sqrt(sum) < 0.02);
    CHECK(counters.rays < exact.rays / 2);
}

TEST_CASE("A lens blurs what is out of focus and leaves what is in it") {
    Scene scene;
    Material lamp = material_of(Material::Kind::matte, Vec3(0.0));
    lamp.emission = Vec3(1.0);
    scene.materials = {lamp};
    scene.camera = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 1e-7};
    scene.camera.lens_radius = 0.5;
    // A small ball in the middle of the picture, at the focus: every ray through the lens meets it.
    const AnalyticTracer in_focus({{AnalyticShape::Kind::sphere, {0, 0, 0}, {}, 0.01, 0}});
    CHECK(path_pixel(scene, in_focus, 1024).color.x == Approx(1).margin(1e-9));
    // Halfway to the focus the cone of rays has radius 0.25, and a ball of radius 0.1 fills (0.1/0.25)² of it.
    const AnalyticTracer before({{AnalyticShape::Kind::sphere, {0, 0, 5}, {}, 0.1, 0}});
    CHECK(path_pixel(scene, before, 1 << 14).color.x == Approx(0.16).epsilon(0.02));
    scene.camera.focus = 5;
    CHECK(path_pixel(scene, before, 1024).color.x == Approx(1).margin(1e-9));
    scene.camera.orthographic = true;
    CHECK(path_pixel(scene, before, 1024).color.x == Approx(1).margin(1e-9));
    scene.camera.focus = 10;
    CHECK(path_pixel(scene, before, 1 << 14).color.x == Approx(0.16).epsilon(0.02));
}

TEST_CASE("A point is projected to where its ray begins, with every projection and shift") {
    for (bool orthographic : {false, true})
        for (Vec3 shift : {Vec3(0.0), Vec3(0.3, -0.8, 0)}) {
            Camera camera{{3, 2, 4}, {0.5, 0, 0}, {0, 1, 0}, 35};
            camera.orthographic = orthographic;
            camera.shift = shift;
            const ProjectiveCamera view(camera, 120, 80);
            for (const Vec2 at : {Vec2(0.5, 0.5), Vec2(60, 40), Vec2(100, 7)}) {
                const Ray ray = view.ray(at.x, at.y);
                const Vec3 seen = view.project(ray.origin + 3.0 * ray.direction);
                CHECK(seen.x == Approx(at.x).epsilon(1e-9));
                CHECK(seen.y == Approx(at.y).epsilon(1e-9));
                CHECK(seen.z == Approx(3 * glm::dot(ray.direction, view.forward())));
                CHECK(close(view.to_eye(ray.origin + 3.0 * ray.direction), -3.0 * ray.direction, 1e-9));
            }
            // The target is in the middle of the picture, up to the shift, and has one size in both projections.
            const Vec3 middle = view.project(camera.target);
            CHECK(middle.x == Approx(60 - shift.x * 120).margin(1e-9));
            CHECK(middle.y == Approx(40 + shift.y * 80).margin(1e-9));
            CHECK(std::abs(view.project(camera.target + Vec3(0, 0.1, 0)).y - middle.y) == Approx(2.29).epsilon(0.02));
        }
}

namespace {

// A box of matte walls with a square light in the ceiling. Its reference tracer follows plain paths, without weights or
// samples of lights: cosine-distributed directions until a path meets the light or has met 100 walls.
struct Cornell {
    Scene scene;
    std::vector<AnalyticShape> walls;
    static constexpr double half_light = 0.5, radiance = 10;

    Cornell() {
        scene.materials = {material_of(Material::Kind::matte, Vec3(0.7)),
                           material_of(Material::Kind::matte, {0.6, 0.1, 0.1}),
                           material_of(Material::Kind::matte, {0.1, 0.5, 0.1})};
        const auto wall = [](Vec3 at, Vec3 normal, int material) {
            return AnalyticShape{AnalyticShape::Kind::plane, at, normal, 0, material};
        };
        walls = {wall({0, -1, 0}, {0, 1, 0}, 0),
                 wall({0, 1, 0}, {0, -1, 0}, 0),
                 wall({-1, 0, 0}, {1, 0, 0}, 1),
                 wall({1, 0, 0}, {-1, 0, 0}, 2),
                 wall({0, 0, -1}, {0, 0, 1}, 0),
                 wall({0, 0, 1}, {0, 0, -1}, 0),
                 {AnalyticShape::Kind::sphere, {-0.3, -0.5, -0.2}, {}, 0.5, 0}};
        scene.lights = {panel_light({0, 1 - 1e-7, 0}, {2 * half_light, 0, 0}, {0, 0, 2 * half_light}, radiance)};
        scene.camera = {{0, 0, 0.9}, {0, -0.1, -1}, {0, 1, 0}, 80};
    }

    Vec3 plain(const AnalyticTracer& tracer, Ray ray, int path) const {
        TraceCounters counters;
        Vec3 throughput(1.0);
        for (std::uint32_t depth = 0; depth < 100; ++depth) {
            const Hit hit = tracer.closest_hit(ray, infinity, counters);
            const bool on_light = hit.position.y > 1 - 1e-6 && std::abs(hit.position.x) < half_light &&
                                  std::abs(hit.position.z) < half_light;
            if (on_light) return throughput * radiance;
            throughput *= scene.materials[hit.material].color.a;
            const Vec3 normal = glm::dot(hit.normal, ray.direction) > 0 ? -hit.normal : hit.normal;
            const Vec2 u = Sampler(11, path >> 12, 0, path & 4095).square(depth);
            ray = leave(hit, cosine_direction(normal, u));
        }
        return Vec3(0.0);
    }
};

}  // namespace

TEST_CASE("A Cornell box has the light of plain paths", "[slow]") {
    const Cornell box;
    const AnalyticTracer tracer(box.walls);
    const int side = 4, plain_paths = 1 << 18, spp = 1 << 15;
    const ProjectiveCamera camera(box.scene.camera, side, side);
    RenderSettings settings{side, side, spp, 5};
    const Integrator integrator(box.scene, tracer, settings);
    Vec3 plain(0.0), found(0.0);
    TraceCounters counters;
    for (int i = 0; i < side * side; ++i) {
        found += integrator.pixel(i % side, i / side, nullptr, counters).color;
        Vec3 sum(0.0);
        for (int k = 0; k < plain_paths; ++k) {
            const Vec2 at = filter_offset(Sampler(12, i, k >> 12, k & 4095).square(0));
            sum += box.plain(tracer, camera.ray(i % side + 0.5 + at.x, i / side + 0.5 + at.y), i * plain_paths + k);
        }
        plain += sum / double(plain_paths);
    }
    for (int k = 0; k < 3; ++k) CHECK(found[k] == Approx(plain[k]).epsilon(0.002));
}

TEST_CASE("Colour and normal for denoisers are those of what mirrors and polished glass show") {
    // The camera looks down on a plate; a red ceiling is above it and a blue floor below.
    const Vec3 red(0.8, 0.1, 0.1), blue(0.1, 0.2, 0.7);
    Scene scene = probe(material_of(Material::Kind::mirror, Vec3(0.5)));
    scene.materials.push_back(material_of(Material::Kind::matte, red));
    scene.materials.push_back(material_of(Material::Kind::matte, blue));
    const AnalyticTracer tracer({{AnalyticShape::Kind::slab, {0, 0, 0}, {0, 1, 0}, 0.5, 0},
                                 {AnalyticShape::Kind::plane, {0, 9, 0}, {0, -1, 0}, 0, 1},
                                 {AnalyticShape::Kind::plane, {0, -3, 0}, {0, 1, 0}, 0, 2}});
    const auto layers_of = [&](Material::Kind kind, double roughness, double ior) {
        scene.materials[0] = material_of(kind, Vec3(0.5), roughness, ior);
        TraceCounters counters;
        RenderSettings settings{1, 1, 64, 0};
        settings.integrator = IntegratorKind::path;
        PixelLayers layers;
        Integrator(scene, tracer, settings).pixel(0, 0, &layers, counters);
        CHECK(close(layers.normal, {0, 1, 0}, 1e-9));  // this layer is of the plate itself
        return layers;
    };
    const PixelLayers mirrored = layers_of(Material::Kind::mirror, 0, 1.5);
    CHECK(close(mirrored.albedo, 0.5 * red, 1e-6));
    CHECK(close(mirrored.guide_normal, {0, -0.5, 0}, 1e-6));
    const PixelLayers passed = layers_of(Material::Kind::glass, 0, 1.0);
    CHECK(close(passed.albedo, 0.25 * blue, 1e-6));
    CHECK(close(passed.guide_normal, {0, 0.25, 0}, 1e-6));
    // 0.04 of the light is reflected at the top; 0.96² of it passes and is tinted twice; inner reflections are small.
    const PixelLayers both = layers_of(Material::Kind::glass, 0, 1.5);
    CHECK(close(both.albedo, 0.04 * red + 0.96 * 0.96 * 0.25 * blue, 0.01));
    const PixelLayers rough = layers_of(Material::Kind::metal, 0.5, 1.5);
    CHECK(close(rough.albedo, Vec3(0.5), 1e-6));
    CHECK(close(rough.guide_normal, {0, 1, 0}, 1e-6));
}
