// Scattering at surfaces: energy, reciprocity, and the densities of samples, for every material.
#include "raytracer/render/scattering.hpp"

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"
#include "raytracer/render/closed_forms.hpp"

using namespace deburr;

namespace {

// Materials of every kind, at roughnesses that cover every case of their tables.
std::vector<Material> all_materials(Vec3 color) {
    using Kind = Material::Kind;
    std::vector<Material> all = {material_of(Kind::matte, color), material_of(Kind::mirror, color)};
    for (double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
        all.push_back(material_of(Kind::metal, color, roughness));
        for (double ior : {1.0, 1.3, 2.4}) {
            all.push_back(material_of(Kind::plastic, color, roughness, ior));
            all.push_back(material_of(Kind::glass, color, roughness, ior));
        }
        Material pbr = material_of(Kind::pbr, color, roughness, 1.45);
        pbr.metallic = 0.3;
        pbr.transmission = 0.4;
        pbr.clearcoat = 0.7;
        pbr.clearcoat_roughness = 1 - roughness;
        all.push_back(pbr);
        pbr.metallic = 0;
        pbr.transmission = 1;
        all.push_back(pbr);
    }
    return all;
}

template <class F>
auto over_sphere(int rows, int columns, F f) {
    decltype(f(up)) sum{};
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) sum += f(at_cosine(2 * (i + 0.5) / rows - 1, 2 * pi * (j + 0.5) / columns));
    return sum * (4 * pi / (rows * columns));
}

Vec3 place(int s) {
    // All surfaces have the same samples; the first million is kept.
    static std::vector<Vec3> kept;
    const std::size_t at = std::size_t(s);
    if (at < kept.size()) return kept[at];
    const Sampler sampler(1, 0, 0, s);
    const Vec2 u = sampler.square(1);
    const Vec3 result{sampler.line(0), u.x, u.y};
    if (at == kept.size() && at < 1 << 20) kept.push_back(result);
    return result;
}

// Radiance that the surface returns in a world of radiance 1, estimated with its own samples.
Vec3 returned(const Scattering& surface, int samples, bool split) {
    Vec3 sum(0.0);
    for (int s = 0; s < samples; ++s) {
        const Vec3 u = place(s);
        for (int half = 0; half < (split ? 2 : 1); ++half) {
            Scattering::Sample next;
            if (surface.sample(half + u.x, {u.y, u.z}, next)) sum += next.weight;
        }
    }
    return sum / double(samples);
}

// The same estimate, with more samples as long as the deviation might be noise.
double white_of(const Scattering& surface, bool split) {
    for (int samples = 1 << 17;; samples *= 8) {
        const double white = returned(surface, samples, split).x;
        if (std::abs(white - 1) < 8e-4 || samples > 1 << 22) return white;
    }
}

}  // namespace

TEST_CASE("Directions around a normal are at right angles to it and turn evenly") {
    int cases = 0;
    for (int i = 0; i <= 10'000; ++i) {
        const double u = i / 10'000.0, phi = 2 * pi * u;
        const Vec3 around_z = cosine_direction({0, 0, 1}, {1, u});
        REQUIRE(close(around_z, {std::cos(phi), std::sin(phi), 0}, 1e-15));
        // The cosine is 0 here; normals point everywhere, also to the south pole.
        const double tilt = pi * (i % 101) / 100;
        const Vec3 normal(std::sin(tilt) * std::cos(i), std::sin(tilt) * std::sin(i), std::cos(tilt));
        const Vec3 around = cosine_direction(normal, {1, u});
        REQUIRE(std::abs(glm::dot(around, normal)) < 1e-15);
        REQUIRE(glm::length(around) == Approx(1).epsilon(1e-15));
        ++cases;
    }
    CHECK(cases == 10'001);
}

TEST_CASE("A white material returns all light of a white furnace, from both sides, to 1e-3", "[slow]") {
    int cases = 0;
    for (const Material& material : all_materials(Vec3(1.0))) {
        AlbedoTables tables;
        const ScatteringMaterial m(material, tables);
        for (double cosine : {0.05, 0.5, 1.0})
            for (double side : {1.0, -1.0}) {
                CAPTURE(int(material.kind), material.roughness, material.ior, cosine, side);
                Scattering surface(m, Vec3(1.0), side * up, at_cosine(cosine));
                CHECK(white_of(surface, false) == Approx(1).margin(1e-3));
                if (surface.split()) CHECK(white_of(surface, true) == Approx(1).margin(1e-3));
                ++cases;
            }
    }
    CHECK(cases == 6 * (2 + 5 * 9));
}

TEST_CASE("A blurred material keeps its energy") {
    int cases = 0;
    for (const Material& material : all_materials(Vec3(1.0))) {
        AlbedoTables tables;
        const ScatteringMaterial m(material, tables, 0.5);
        CAPTURE(int(material.kind), material.roughness, material.ior);
        const double sum = returned(Scattering(m, Vec3(1.0), up, at_cosine(0.5)), 1 << 14, false).x;
        CHECK(sum == Approx(1).margin(4e-3));
        ++cases;
    }
    CHECK(cases == 2 + 5 * 9);
}

TEST_CASE("No colour returns more light than white") {
    for (const Material& material : all_materials(Vec3(0.9, 0.4, 0.0))) {
        AlbedoTables tables;
        const ScatteringMaterial m(material, tables);
        for (double cosine : {0.1, 0.6, 1.0}) {
            CAPTURE(int(material.kind), material.roughness, material.ior, cosine);
            const Vec3 sum = returned(Scattering(m, Vec3(0.9, 0.4, 0.0), up, at_cosine(cosine)), 1 << 12, false);
            for (int k = 0; k < 3; ++k) {
                CHECK(sum[k] <= 1.002);
                CHECK(sum[k] >= 0);
            }
        }
    }
}

TEST_CASE("Samples of every material have the density and the value that are claimed", "[slow]") {
    int cases = 0;
    for (const Material& material : all_materials(Vec3(0.8, 0.5, 0.3))) {
        if (material.roughness < 0.5 || material.kind == Material::Kind::mirror) continue;  // too narrow for the grid
        if (material.clearcoat > 0 && material.clearcoat_roughness < 0.3) continue;
        if (material.kind == Material::Kind::glass && material.ior == 1) continue;
        AlbedoTables tables;
        const ScatteringMaterial m(material, tables);
        for (double cosine : {0.3, 0.9})
            for (double side : {1.0, -1.0})
                for (bool split : {false, true}) {
                    CAPTURE(int(material.kind), material.roughness, material.ior, cosine, side, split);
                    Scattering surface(m, Vec3(0.8, 0.5, 0.3), side * up, at_cosine(cosine));
                    if (split && !surface.split()) continue;
                    const auto observable = [](Vec3 w) { return (1 + w.x) * (1.5 + w.y) * (1.3 + w.z); };
                    const double hit_exact =
                        over_sphere(500, 300, [&](Vec3 w) { return surface.value(w).density * observable(w); });
                    const double light_exact =
                        over_sphere(500, 300, [&](Vec3 w) { return surface.value(w).value.y * observable(w); });
                    double hits = 0, light = 0;
                    const int n = 1 << 18;
                    for (int s = 0; s < n; ++s)
                        for (int half = 0; half < (split ? 2 : 1); ++half) {
                            const Vec3 u = place(s);
                            Scattering::Sample next;
                            if (!surface.sample(half + u.x, {u.y, u.z}, next)) continue;
                            hits += observable(next.direction) / n;
                            light += next.weight.y * observable(next.direction) / n;
                        }
                    CHECK(hits == Approx(hit_exact).epsilon(0.015));
                    CHECK(light == Approx(light_exact).epsilon(0.015));
                    ++cases;
                }
    }
    CHECK(cases > 60);
}

TEST_CASE("Reflections of opaque materials are reciprocal") {
    int cases = 0;
    using Kind = Material::Kind;
    for (const Material& material : all_materials(Vec3(0.7))) {
        if (material.kind == Kind::glass || material.kind == Kind::pbr) continue;
        AlbedoTables tables;
        const ScatteringMaterial m(material, tables);
        for (int s = 0; s < 200; ++s) {
            const Vec2 p = Sampler(2, 0, 0, s).square(0), q = Sampler(2, 0, 0, s).square(1);
            const Vec3 a = at_cosine(0.01 + 0.99 * p.x, 2 * pi * p.y), b = at_cosine(0.01 + 0.99 * q.x, 2 * pi * q.y);
            const double there = Scattering(m, Vec3(0.7), up, a).value(b).value.x / b.z;
            const double back = Scattering(m, Vec3(0.7), up, b).value(a).value.x / a.z;
            CHECK(std::abs(there - back) <= 1e-9 * (there + back));
            ++cases;
        }
    }
    CHECK(cases == 200 * (2 + 5 * 4));
}
