// GGX, Fresnel's equations and refraction against known values.
#include "raytracer/render/bsdf.hpp"

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"
#include "raytracer/render/closed_forms.hpp"

using namespace deburr;

TEST_CASE("GGX facets cover the projected area once") {
    for (double alpha : {0.05, 0.3, 1.0}) {
        const Ggx ggx{alpha};
        const int n = 4000;  // evenly spaced in tan θ, where the peak is wide for every α
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
    // At Brewster's angle, tan θ = ior, only s-polarized light is reflected, by ((ior² − 1)/(ior² + 1))².
    const double s = (2.25 - 1) / (2.25 + 1);
    CHECK(fresnel_dielectric(1 / std::sqrt(1 + 2.25), 1.5) == Approx(0.5 * s * s).epsilon(1e-12));
    // Total internal reflection begins at sin θ = 1/ior.
    const double critical = std::sqrt(1 - 1 / 2.25);
    CHECK(fresnel_dielectric(critical - 1e-6, 1 / 1.5) == 1);
    CHECK(fresnel_dielectric(critical + 1e-3, 1 / 1.5) < 1);
    // Light along the reversed path is reflected by the same fraction.
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
