// Vectorized shading of batches against a plain implementation, bit by bit.
#include "raytracer/render/shading_kernels.hpp"

#include <bit>
#include <numbers>
#include <optional>

#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/render/analytic_tracer.hpp"
#include "raytracer/render/closed_forms.hpp"

using namespace deburr;

namespace {

std::vector<SurfaceLayer> opaque_layers() {
    using Kind = Material::Kind;
    const auto layer = [](Kind kind, double roughness, double ior) {
        return SurfaceLayer({kind, plain_texture(0.5), roughness, ior});
    };
    std::vector<SurfaceLayer> layers = {layer(Kind::matte, 0, 1.5), layer(Kind::mirror, 0, 1.5)};
    for (double roughness : {0.0, 0.2, 0.4, 0.7, 1.0}) {
        layers.push_back(layer(Kind::metal, roughness, 1.5));
        for (double ior : {1.3, 1.5, 2.4}) layers.push_back(layer(Kind::plastic, roughness, ior));
    }
    return layers;
}

// The definition in bsdf.hpp for an opaque material at one point seen from one direction: a layer over a base.
struct PlainSurface {
    using Kind = Material::Kind;
    const SurfaceLayer& layer;
    Vec3 color, normal, to_eye;

    double cos_eye() const { return std::max(glm::dot(normal, to_eye), 1e-5); }
    double albedo_eye() const { return layer.kind() == Kind::matte ? 0.0 : layer.albedo(cos_eye()); }
    Vec3 base() const {
        if (layer.kind() == Kind::mirror || (layer.kind() == Kind::metal && layer.smooth())) return Vec3(0.0);
        if (layer.kind() != Kind::metal) return color;
        const Vec3 f = color + (1.0 - color) / 21.0;
        const double e = layer.mean_albedo();
        return f * f * e / (1.0 - f * (1 - e));
    }
    Vec3 fresnel(double cosine) const {
        switch (layer.kind()) {
            case Kind::mirror: return color;
            case Kind::metal: return fresnel_schlick(color, cosine);
            case Kind::matte: return Vec3(0.0);
            default: return Vec3(fresnel_dielectric(cosine, layer.ior()));
        }
    }
    Vec3 base_albedo() const { return base() * (1 - albedo_eye()); }
    Vec3 layer_albedo() const {
        return layer.kind() == Kind::plastic ? Vec3(albedo_eye()) : fresnel(cos_eye()) * albedo_eye();
    }
    // BSDF times the light's cosine; `visibility` is G2/(4 cos cos) of Smith's height-correlated masking.
    Vec3 scattered(Vec3 to_light) const {
        const double c = glm::dot(normal, to_light);
        if (!(c > 0)) return Vec3(0.0);
        if (layer.kind() == Kind::matte) return base() * (c * std::numbers::inv_pi);
        const Vec3 below = base() * (c * (1 - albedo_eye()) * (1 - layer.albedo(c)) * layer.base_share());
        if (layer.smooth()) return below;
        const double a2 = layer.ggx().alpha * layer.ggx().alpha, o = cos_eye();
        const double visibility = 0.5 / (o * std::sqrt(a2 + (1 - a2) * c * c) + c * std::sqrt(a2 + (1 - a2) * o * o));
        const Vec3 half = glm::normalize(to_eye + to_light);
        return below +
               fresnel(glm::dot(half, to_light)) * (layer.ggx().distribution(glm::dot(half, normal)) * visibility * c);
    }
};

bool same_up_to_zero_signs(Vec3 a, Vec3 b) {
    // A sum may start at 0 or at its first term, so zeros may differ in sign.
    for (int k = 0; k < 3; ++k)
        if (std::bit_cast<std::uint64_t>(a[k] + 0.0) != std::bit_cast<std::uint64_t>(b[k] + 0.0)) return false;
    return true;
}

Light any_light(Gen& g, Light::Kind kind) {
    Light light;
    light.kind = kind;
    light.position = g.point(3);
    light.direction = g.normal();
    light.u = g.point(1);
    light.v = g.point(1);
    light.color = Vec3(g.between(0, 1), g.between(0, 1), g.between(0, 1));
    light.power = g.between(1, 100);
    return light;
}

Background any_sky(Gen& g) {
    Background sky;
    sky.sky = g.chance(0.7);
    sky.z_up = g.chance(0.5);
    sky.color = Vec3(g.between(0, 1), g.between(0, 1), g.between(0, 1));
    sky.zenith = Vec3(g.between(0, 1), g.between(0, 1), g.between(0, 1));
    return sky;
}

// A batch of surfaces with random layers; some are seen from inside, some edge-on.
struct RandomBatch {
    SurfaceArrays<64> arrays;
    SurfaceBatch batch;

    RandomBatch(Gen& g, std::size_t layers) : batch(arrays.batch(std::size_t(1 + g.below(64)))) {
        int layer = 0;
        for (std::size_t i = 0; i < batch.count; ++i) {
            if (g.chance(0.3)) layer = g.below(int(layers));
            batch.layer[i] = layer;
            const Vec3 normal = g.normal();
            Vec3 to_eye = g.normal();
            const Vec3 edge_on = to_eye - glm::dot(to_eye, normal) * normal;
            if (g.chance(0.1) && glm::length(edge_on) > 1e-3) to_eye = glm::normalize(edge_on);
            batch.set(SurfaceField::position, i, g.point(1));
            batch.set(SurfaceField::normal, i, normal);
            batch.set(SurfaceField::to_eye, i, to_eye);
            batch.set(SurfaceField::color, i, Vec3(g.between(0, 1), g.between(0, 1), g.chance(0.2) ? 1.0 : 0.3));
            batch.array(SurfaceField::place, 0)[i] = g.between(0, 1);
            batch.array(SurfaceField::place, 1)[i] = g.between(0, 1);
        }
    }
    PlainSurface plain(const std::vector<SurfaceLayer>& layers, std::size_t i) const {
        return {layers[std::size_t(batch.layer[i])], batch.vec(SurfaceField::color, i),
                batch.vec(SurfaceField::normal, i), batch.vec(SurfaceField::to_eye, i)};
    }
};

// A batch of one surface, with the reflectances of its base and layer in a uniformly white world.
struct One {
    SurfaceArrays<8> arrays;
    SurfaceBatch batch = arrays.batch(1);
    std::span<const SurfaceLayer> layer;

    One(const SurfaceLayer& of, Vec3 color, Vec3 to_eye) : layer(&of, 1) {
        batch.set(SurfaceField::normal, 0, Vec3(0, 0, 1));
        batch.set(SurfaceField::to_eye, 0, to_eye);
        batch.set(SurfaceField::color, 0, color);
        shading_functions.see(layer, batch);
    }
    Vec3 albedo() {
        shading_functions.mirror(layer, batch);
        return batch.vec(SurfaceField::base, 0) * (1 - batch.get(SurfaceField::albedo_eye, 0)) +
               batch.vec(SurfaceField::layer_albedo, 0);
    }
    Vec3 scattered(Vec3 to_light) {
        batch.set(SurfaceField::towards, 0, to_light);
        batch.set(SurfaceField::irradiance, 0, Vec3(1.0));
        shading_functions.scatter(layer, batch);
        return batch.vec(SurfaceField::scattered, 0);
    }
};

}  // namespace

TEST_CASE("surfaces of a batch are shaded as the plain definition says, to the bit") {
    const std::vector<SurfaceLayer> layers = opaque_layers();
    REQUIRE(layers.size() == 22);
    for (const auto& [name, functions] : shading_instructions()) {
        CAPTURE(name);
        int lit = 0, dark = 0;
        for (auto seed : seeds(1'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const RandomBatch c(g, layers.size());
            const SurfaceBatch& batch = c.batch;
            const Vec3 ambient(0.1, 0.2, 0.3);
            const SkyLight sky(any_sky(g));
            const std::vector<Vec3> outward = [&] {
                std::vector<Vec3> all;
                for (std::size_t i = 0; i < batch.count; ++i) all.push_back(batch.vec(SurfaceField::normal, i));
                return all;
            }();
            functions->see(layers, batch);
            for (std::size_t i = 0; i < batch.count; ++i) {
                const PlainSurface plain = c.plain(layers, i);
                const bool within = glm::dot(outward[i], plain.to_eye) < 0;
                CHECK(same_up_to_zero_signs(plain.normal, within ? -outward[i] : outward[i]));
                CHECK(same_up_to_zero_signs(batch.vec(SurfaceField::base, i), plain.base()));
                CHECK(batch.get(SurfaceField::albedo_eye, i) == plain.albedo_eye());
            }
            for (auto kind : {Light::Kind::point, Light::Kind::directional, Light::Kind::area}) {
                const LightSource source(any_light(g, kind));
                functions->incident(source, batch);
                functions->scatter(layers, batch);
                for (std::size_t i = 0; i < batch.count; ++i) {
                    const Vec2 place(batch.array(SurfaceField::place, 0)[i], batch.array(SurfaceField::place, 1)[i]);
                    const Incident light = source.at(batch.vec(SurfaceField::position, i), place);
                    CHECK(same_up_to_zero_signs(batch.vec(SurfaceField::irradiance, i), light.irradiance));
                    if (light.irradiance == Vec3(0.0)) continue;
                    CHECK(same_up_to_zero_signs(batch.vec(SurfaceField::towards, i), light.direction));
                    CHECK(batch.get(SurfaceField::distance, i) == light.distance);
                    const Vec3 expected = c.plain(layers, i).scattered(light.direction) * light.irradiance;
                    CHECK(same_up_to_zero_signs(batch.vec(SurfaceField::scattered, i), expected));
                    ++(expected == Vec3(0.0) ? dark : lit);
                }
            }
            for (std::size_t i = 0; i < batch.count; ++i) batch.set(SurfaceField::lit, i, Vec3(0.5, 0.25, 0.125));
            functions->mirror(layers, batch);
            functions->sky(sky, layers, batch);
            functions->shade(ambient, layers, batch);
            for (std::size_t i = 0; i < batch.count; ++i) {
                const PlainSurface plain = c.plain(layers, i);
                const Vec3 mirrored = reflected(plain.to_eye, plain.normal);
                Vec3 returned = plain.base_albedo() * sky.mean(plain.normal);
                if (plain.layer.kind() != Material::Kind::matte)
                    returned +=
                        plain.layer_albedo() * glm::mix(sky.towards(mirrored), sky.mean(mirrored), plain.layer.blur());
                const Vec3 expected = plain.base_albedo() * ambient + Vec3(0.5, 0.25, 0.125) + returned;
                CHECK(same_up_to_zero_signs(batch.vec(SurfaceField::shaded, i), expected));
            }
        }
        CHECK(lit > 20'000);
        CHECK(dark > 5'000);
    }
}

TEST_CASE("No material returns more light than it gets, at any angle") {
    int cases = 0;
    for (const SurfaceLayer& layer : opaque_layers())
        for (int i = 1; i <= 200; ++i) {
            const Vec3 albedo = One(layer, Vec3(0.9, 0.5, 0.0), at_cosine(i / 200.0)).albedo();
            CHECK(albedo.x <= 1 + 1e-12);
            CHECK(albedo.z >= 0);
            ++cases;
        }
    CHECK(cases == 200 * 22);
}

TEST_CASE("Scattering is reciprocal") {
    int cases = 0;
    for (const SurfaceLayer& layer : opaque_layers())
        for (int s = 0; s < 500; ++s) {
            const Sampler sampler(2, 0, 0, s);
            const Vec2 p = sampler.square(0), q = sampler.square(1);
            const Vec3 a = at_cosine(0.01 + 0.99 * p.x, 2 * pi * p.y);
            const Vec3 b = at_cosine(0.01 + 0.99 * q.x, 2 * pi * q.y);
            const double there = One(layer, Vec3(0.7), a).scattered(b).x / b.z;
            const double back = One(layer, Vec3(0.7), b).scattered(a).x / a.z;
            CHECK(std::abs(there - back) <= 1e-9 * (there + back));
            ++cases;
        }
    CHECK(cases == 500 * 22);
}
