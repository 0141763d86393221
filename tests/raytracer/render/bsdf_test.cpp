#include "raytracer/render/bsdf.hpp"

#include <functional>

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"

using namespace deburr;

namespace {

const Vec3 up(0, 0, 1);

Vec3 at_cosine(double c, double azimuth = 0) {
    const double s = std::sqrt(1 - c * c);
    return {s * std::cos(azimuth), s * std::sin(azimuth), c};
}

struct Case {
    Material::Kind kind;
    double roughness, ior;
};

std::vector<Case> opaque_materials() {
    std::vector<Case> cases = {{Material::Kind::matte, 0, 1.5}, {Material::Kind::mirror, 0, 1.5}};
    for (double roughness : {0.0, 0.2, 0.4, 0.7, 1.0}) {
        cases.push_back({Material::Kind::metal, roughness, 1.5});
        for (double ior : {1.3, 1.5, 2.4}) cases.push_back({Material::Kind::plastic, roughness, ior});
    }
    return cases;
}

}  // namespace

TEST_CASE("No material returns more light than it gets, at any angle") {
    int cases = 0;
    for (const Case& c : opaque_materials()) {
        const SurfaceLayer layer({c.kind, plain(1.0), c.roughness, c.ior});
        for (int i = 1; i <= 200; ++i) {
            const Bsdf bsdf(layer, Vec3(0.9, 0.5, 0.0), up, at_cosine(i / 200.0));
            const Vec3 albedo = bsdf.base_albedo() + bsdf.layer_albedo();
            CHECK(albedo.x <= 1 + 1e-12);
            CHECK(albedo.z >= 0);
            ++cases;
        }
    }
    CHECK(cases == 200 * 22);
}

TEST_CASE("Scattering is reciprocal") {
    int cases = 0;
    for (const Case& c : opaque_materials()) {
        const SurfaceLayer layer({c.kind, plain(0.7), c.roughness, c.ior});
        for (int s = 0; s < 500; ++s) {
            const Sampler sampler(2, 0, 0, s);
            const Vec2 p = sampler.square(0), q = sampler.square(1);
            const Vec3 a = at_cosine(0.01 + 0.99 * p.x, 2 * pi * p.y);
            const Vec3 b = at_cosine(0.01 + 0.99 * q.x, 2 * pi * q.y);
            const auto ab = Bsdf(layer, Vec3(0.7), up, a).value(b);
            const auto ba = Bsdf(layer, Vec3(0.7), up, b).value(a);
            const double there = (ab.base.x + ab.layer.x) / b.z, back = (ba.base.x + ba.layer.x) / a.z;
            CHECK(std::abs(there - back) <= 1e-9 * (there + back));
            ++cases;
        }
    }
    CHECK(cases == 500 * 22);
}

TEST_CASE("GGX facets cover the projected area once") {
    for (double alpha : {0.05, 0.3, 1.0}) {
        const Ggx ggx{alpha};
        const int n = 4000;  // even in tan θ, where the peak is wide at every α
        double area = 0;
        for (int i = 0; i < n; ++i) {
            const double t = (i + 0.5) / n, tangent = alpha * t / (1 - t);
            const double c = 1 / std::sqrt(1 + tangent * tangent);
            // dω cos = 2π sinθ cosθ dθ, dθ = cos² d tan
            area += ggx.distribution(c) * 2 * pi * tangent * c * c * c * c * alpha / ((1 - t) * (1 - t)) / n;
        }
        CHECK(area == Approx(1).epsilon(1e-4));
    }
}

TEST_CASE("Fresnel's equations have their known values") {
    CHECK(fresnel_dielectric(1, 1.5) == Approx(0.04).epsilon(1e-12));
    CHECK(fresnel_dielectric(1, 1 / 1.5) == Approx(0.04).epsilon(1e-12));
    CHECK(fresnel_dielectric(0, 1.5) == Approx(1));
    // Brewster's angle, tan = ior: only s is reflected, by ((ior² − 1)/(ior² + 1))².
    const double s = (2.25 - 1) / (2.25 + 1);
    CHECK(fresnel_dielectric(1 / std::sqrt(1 + 2.25), 1.5) == Approx(0.5 * s * s).epsilon(1e-12));
    // Total reflection begins at sin = 1/ior.
    const double critical = std::sqrt(1 - 1 / 2.25);
    CHECK(fresnel_dielectric(critical - 1e-6, 1 / 1.5) == 1);
    CHECK(fresnel_dielectric(critical + 1e-3, 1 / 1.5) < 1);
    // The way back reflects the same.
    int cases = 0;
    for (int i = 1; i < 100; ++i) {
        Vec3 through;
        REQUIRE(refracted(at_cosine(i / 100.0), up, 1.5, through));
        CHECK(fresnel_dielectric(i / 100.0, 1.5) == Approx(fresnel_dielectric(-through.z, 1 / 1.5)).epsilon(1e-9));
        ++cases;
    }
    CHECK(cases == 99);
}

TEST_CASE("Refraction obeys Snell's law and reflection the mirror's") {
    int passed = 0, total = 0;
    for (double ior : {1.5, 1 / 1.5, 1.0, 2.4})
        for (int i = 1; i <= 100; ++i) {
            const Vec3 eye = at_cosine(i / 100.0, 0.3 * i);
            CHECK(close(reflected(eye, up), {-eye.x, -eye.y, eye.z}, 1e-15));
            const double sine = std::sqrt(1 - eye.z * eye.z);
            Vec3 through;
            if (!refracted(eye, up, ior, through)) {
                CHECK(sine / ior >= 1 - 1e-12);
                ++total;
                continue;
            }
            CHECK(glm::length(through) == Approx(1).epsilon(1e-14));
            CHECK(close({through.x, through.y, 0}, Vec3(-eye.x, -eye.y, 0) / ior, 1e-12));
            CHECK(through.z < 0);
            ++passed;
        }
    CHECK(passed > 300);
    CHECK(total > 20);
}
