#include "raytracer/render/shading_kernels.hpp"

#include <numbers>

#include "raytracer/simd/disabled_targets.hpp"

// This file is compiled once for each instruction set, like raytracer/simd/packet_kernels.cpp.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytracer/render/shading_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "raytracer/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {
namespace {

using std::numbers::inv_pi;
// Least cosine at a shading point, since G and E are 0/0 at 0.
constexpr double min_cosine = 1e-5;

// Vectors of several surfaces.
struct V3 {
    V x, y, z;
};
DEBURR_INLINE V3 numbers(Vec3 v) { return {number(v.x), number(v.y), number(v.z)}; }
DEBURR_INLINE V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
DEBURR_INLINE V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
DEBURR_INLINE V3 operator*(V3 a, V3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
DEBURR_INLINE V3 operator*(V3 a, V b) { return {a.x * b, a.y * b, a.z * b}; }
DEBURR_INLINE V3 operator/(V3 a, V3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
DEBURR_INLINE V3 operator/(V3 a, V b) { return {a.x / b, a.y / b, a.z / b}; }
DEBURR_INLINE V3 negative(V3 a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
DEBURR_INLINE V3 select3(M m, V3 a, V3 b) { return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)}; }
DEBURR_INLINE V dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DEBURR_INLINE V3 mix(V3 a, V3 b, V t) { return a * (number(1) - t) + b * t; }
DEBURR_INLINE V3 unit(V3 a) { return a * (number(1) / hn::Sqrt(dot(a, a))); }
// Chooses as glm::clamp does, which differs from std::clamp for NaN.
DEBURR_INLINE V clamped_as_glm(V x, V lo, V hi) { return least(most(x, lo), hi); }

// The surfaces of a batch from `first` on, as many as a vector holds: all of them, or those in `asked`.
class Some {
public:
    Some(const SurfaceBatch& batch, std::size_t first) : batch_(batch), first_(first) {}
    Some(const SurfaceBatch& batch, std::size_t first, Lanes asked)
        : batch_(batch), first_(first), some_(asked != all), asked_(mask_of(asked)) {}

    V get(SurfaceField field, int axis = 0) const { return hn::Load(d, batch_.array(field, axis) + first_); }
    V3 get3(SurfaceField field) const { return {get(field, 0), get(field, 1), get(field, 2)}; }
    void set(SurfaceField field, V value, int axis = 0) const {
        double* const to = batch_.array(field, axis) + first_;
        hn::Store(some_ ? select(asked_, value, hn::Load(d, to)) : value, d, to);
    }
    void set3(SurfaceField field, V3 value) const {
        set(field, value.x, 0);
        set(field, value.y, 1);
        set(field, value.z, 2);
    }
    bool any(M lanes) const { return !none(some_ ? and_(lanes, asked_) : lanes); }

    static constexpr Lanes all = (Lanes(1) << hn::MaxLanes(D())) - 1;

private:
    const SurfaceBatch& batch_;
    std::size_t first_;
    bool some_ = false;
    M asked_ = mask_of(all);
};

// Calls each(some) for all surfaces, and for the unused elements after the last one.
template <class Each>
DEBURR_INLINE void for_all(const SurfaceBatch& batch, Each each) {
    for (std::size_t first = 0; first < batch.count; first += hn::Lanes(d)) each(Some(batch, first));
}

// Calls each(layer, some) for all surfaces, once for each layer among the surfaces in a vector.
template <class Each>
DEBURR_INLINE void for_layers(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch, Each each) {
    constexpr std::size_t lanes = hn::MaxLanes(D());
    for (std::size_t first = 0; first < batch.count; first += lanes) {
        const std::size_t here = std::min(lanes, batch.count - first);
        const std::int32_t* const of = batch.layer + first;
        for (Lanes left = (Lanes(1) << here) - 1; left != 0;) {
            const std::int32_t layer = of[__builtin_ctz(left)];
            Lanes same = 0;
            for (std::size_t k = 0; k < lanes; ++k) same |= Lanes(of[k] == layer) << k;
            each(layers[std::size_t(layer)], Some(batch, first, same));
            left &= ~same;
        }
    }
}

// Interpolates linearly in a table of `steps` + 1 values at a position from 0 to `steps`.
DEBURR_INLINE V interpolated(const double* table, int steps, V at) {
    using Whole = hn::RebindToSigned<D>;
    const Whole w;
    // The last interval for NaN, too.
    const V left = select(at < number(steps), hn::Floor(at), number(steps - 1));
    // The lowest bits of 2⁵² plus an integer are those of the integer.
    const auto index = hn::And(hn::BitCast(w, left + number(0x1p52)), hn::Set(w, 0xffff));
    const V a = hn::GatherIndex(d, table, index), b = hn::GatherIndex(d, table + 1, index), t = at - left;
    return a * (number(1) - t) + b * t;
}

DEBURR_INLINE V albedo(const SurfaceLayer& layer, V cosine) {
    const auto& table = layer.albedo_table();
    const int steps = int(table.size()) - 1;
    return interpolated(table.data(), steps, hn::Sqrt(clamped_as_glm(cosine, number(0), number(1))) * number(steps));
}

DEBURR_INLINE V fresnel_dielectric(V cosine, double ior) {
    const V c = clamped_as_glm(hn::Abs(cosine), number(0), number(1));
    const V g2 = number(ior * ior - 1) + c * c;
    const V g = hn::Sqrt(g2), far = number(ior * ior) * c, inverse = number(1) / ((c + g) * (far + g));
    const V s = (c - g) * (far + g) * inverse, p = (far - g) * (c + g) * inverse;
    return select(g2 <= number(0), number(1), number(0.5) * (s * s + p * p));
}

DEBURR_INLINE V3 fresnel(const SurfaceLayer& layer, V3 color, V cosine) {
    switch (layer.kind()) {
        case Material::Kind::mirror: return color;
        case Material::Kind::metal: {
            const V x = number(1) - clamped_as_glm(cosine, number(0), number(1));
            return color + (numbers(Vec3(1)) - color) * (x * x * x * x * x);
        }
        case Material::Kind::matte: return numbers(Vec3(0));
        default: {
            const V f = fresnel_dielectric(cosine, layer.ior());
            return {f, f, f};
        }
    }
}

void see(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch) {
    for_layers(layers, batch, [](const SurfaceLayer& layer, const Some& some) HWY_ATTR {
        const V3 to_eye = some.get3(SurfaceField::to_eye), outward = some.get3(SurfaceField::normal),
                 color = some.get3(SurfaceField::color);
        const V3 normal = select3(dot(outward, to_eye) < number(0), negative(outward), outward);
        const V cosine = most(dot(normal, to_eye), number(min_cosine));
        const bool metal = layer.kind() == Material::Kind::metal;
        V3 base = color;
        if (layer.kind() == Material::Kind::mirror || (metal && layer.smooth())) {
            base = numbers(Vec3(0));
        } else if (metal) {
            // Light that leaves after one, two, … further reflections, each with the mean Fresnel reflectance.
            const V3 one = numbers(Vec3(1)), f = color + (one - color) / number(21);
            const double e = layer.mean_albedo();
            base = f * f * number(e) / (one - f * number(1 - e));
        }
        some.set3(SurfaceField::normal, normal);
        some.set(SurfaceField::cos_eye, cosine);
        some.set(SurfaceField::albedo_eye, layer.kind() == Material::Kind::matte ? number(0) : albedo(layer, cosine));
        some.set3(SurfaceField::base, base);
        some.set3(SurfaceField::lit, numbers(Vec3(0)));
    });
}

void incident_from_afar(const LightSource& source, const SurfaceBatch& batch) {
    for_all(batch, [&source](const Some& some) HWY_ATTR {
        some.set3(SurfaceField::towards, numbers(-source.direction()));
        some.set(SurfaceField::distance, number(infinity));
        some.set3(SurfaceField::irradiance, numbers(source.emitted()));
    });
}

void incident(const LightSource& source, const SurfaceBatch& batch) {
    if (source.kind() == Light::Kind::directional) return incident_from_afar(source, batch);
    const bool area = source.kind() == Light::Kind::area;
    for_all(batch, [&source, area](const Some& some) HWY_ATTR {
        V3 from = numbers(source.position());
        if (area)
            from = from + (numbers(source.u()) * (some.get(SurfaceField::place, 0) - number(0.5)) +
                           numbers(source.v()) * (some.get(SurfaceField::place, 1) - number(0.5)));
        const V3 to_light = from - some.get3(SurfaceField::position);
        const V square = dot(to_light, to_light), distance = hn::Sqrt(square), inverse = number(1) / distance;
        const V3 towards = to_light * inverse;
        V3 irradiance;
        M shines = square > number(0);
        if (area) {
            const V cosine = hn::Neg(dot(numbers(source.direction()), towards));
            shines = and_(and_(shines, cosine > number(0)), number(source.area()) > number(0));
            irradiance = numbers(source.emitted()) / (square / (cosine * number(source.area())));
        } else {
            irradiance = numbers(source.emitted()) * (inverse * inverse);
        }
        some.set3(SurfaceField::towards, towards);
        some.set(SurfaceField::distance, distance);
        some.set3(SurfaceField::irradiance, select3(shines, irradiance, numbers(Vec3(0))));
    });
}

DEBURR_INLINE V distribution(const Ggx& ggx, V cos_half) {
    const double a2 = ggx.alpha * ggx.alpha;
    const V t = cos_half * cos_half * number(a2 - 1) + number(1);
    return number(a2) / (number(pi) * t * t);
}

DEBURR_INLINE V visibility(const Ggx& ggx, V cos_in, V cos_out) {
    const double a2 = ggx.alpha * ggx.alpha;
    const V in = hn::Sqrt(number(a2) + number(1 - a2) * cos_in * cos_in);
    const V out = hn::Sqrt(number(a2) + number(1 - a2) * cos_out * cos_out);
    return number(0.5) / (cos_out * in + cos_in * out);
}

// The light that base and layer scatter, times the cosine of the light's direction.
DEBURR_INLINE V3 scattered(const SurfaceLayer& layer, const Some& some, V3 normal, V3 towards, V cos_light) {
    const V3 base = some.get3(SurfaceField::base);
    if (layer.kind() == Material::Kind::matte) return base * (cos_light * number(inv_pi));
    const V3 below = base * (cos_light * (number(1) - some.get(SurfaceField::albedo_eye)) *
                             (number(1) - albedo(layer, cos_light)) * number(layer.base_share()));
    if (layer.smooth()) return below;
    const V3 half = unit(some.get3(SurfaceField::to_eye) + towards);
    return below + fresnel(layer, some.get3(SurfaceField::color), dot(half, towards)) *
                       (distribution(layer.ggx(), dot(half, normal)) *
                        visibility(layer.ggx(), cos_light, some.get(SurfaceField::cos_eye)) * cos_light);
}

void scatter(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch) {
    for_layers(layers, batch, [](const SurfaceLayer& layer, const Some& some) HWY_ATTR {
        const V3 normal = some.get3(SurfaceField::normal), towards = some.get3(SurfaceField::towards);
        const V cos_light = dot(normal, towards);
        const M lit = cos_light > number(0);
        const V3 nothing = numbers(Vec3(0));
        if (!some.any(lit)) return some.set3(SurfaceField::scattered, nothing);
        const V3 light = scattered(layer, some, normal, towards, cos_light) * some.get3(SurfaceField::irradiance);
        some.set3(SurfaceField::scattered, select3(lit, light, nothing));
    });
}

void mirror(std::span<const SurfaceLayer> layers, const SurfaceBatch& batch) {
    for_layers(layers, batch, [](const SurfaceLayer& layer, const Some& some) HWY_ATTR {
        if (layer.kind() == Material::Kind::matte) return;
        const V3 normal = some.get3(SurfaceField::normal), to_eye = some.get3(SurfaceField::to_eye);
        some.set3(SurfaceField::towards, normal * (number(2) * dot(to_eye, normal)) - to_eye);
        const V albedo = some.get(SurfaceField::albedo_eye);
        const bool plastic = layer.kind() == Material::Kind::plastic;
        some.set3(SurfaceField::layer_albedo,
                  plastic ? V3{albedo, albedo, albedo}
                          : fresnel(layer, some.get3(SurfaceField::color), some.get(SurfaceField::cos_eye)) * albedo);
    });
}

// The sky as in SkyLight, for a gradient or a constant colour.
DEBURR_INLINE V height(const Background& sky, V3 direction) { return sky.z_up ? direction.z : direction.y; }

DEBURR_INLINE V3 mean_sky(const SkyLight& light, V3 normal) {
    const Background& sky = light.background();
    if (!sky.sky) return numbers(sky.color);
    const auto& shares = light.zenith_shares();
    const int steps = int(shares.size()) - 1;
    const V up = clamped_as_glm(number(0.5) * (height(sky, normal) + number(1)), number(0), number(1));
    return mix(numbers(sky.horizon), numbers(sky.zenith), interpolated(shares.data(), steps, up * number(steps)));
}

DEBURR_INLINE V3 sky_towards(const SkyLight& light, V3 direction) {
    const Background& sky = light.background();
    if (!sky.sky) return numbers(sky.color);
    return mix(numbers(sky.horizon), numbers(sky.zenith), hn::Sqrt(most(number(0), height(sky, direction))));
}

void sky(const SkyLight& light, std::span<const SurfaceLayer> layers, const SurfaceBatch& batch) {
    for_layers(layers, batch, [&light](const SurfaceLayer& layer, const Some& some) HWY_ATTR {
        some.set3(SurfaceField::sky, mean_sky(light, some.get3(SurfaceField::normal)));
        if (layer.kind() == Material::Kind::matte) return;
        const V3 towards = some.get3(SurfaceField::towards);
        some.set3(SurfaceField::mirrored,
                  mix(sky_towards(light, towards), mean_sky(light, towards), number(layer.blur())));
    });
}

void shade(Vec3 ambient, std::span<const SurfaceLayer> layers, const SurfaceBatch& batch) {
    for_layers(layers, batch, [ambient](const SurfaceLayer& layer, const Some& some) HWY_ATTR {
        const V3 base = some.get3(SurfaceField::base) * (number(1) - some.get(SurfaceField::albedo_eye));
        V3 reflected = base * some.get3(SurfaceField::sky);
        if (layer.kind() != Material::Kind::matte)
            reflected = reflected + some.get3(SurfaceField::layer_albedo) * some.get3(SurfaceField::mirrored);
        some.set3(SurfaceField::shaded, base * numbers(ambient) + some.get3(SurfaceField::lit) + reflected);
    });
}

}  // namespace

const ShadingFunctions functions{see, incident, scatter, mirror, sky, shade};

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "raytracer/simd/instruction_sets-inl.hpp"

namespace deburr {

std::vector<Instructions<ShadingFunctions>> shading_instructions() {
    DEBURR_INSTRUCTION_SETS(ShadingFunctions, functions)
}

const ShadingFunctions& shading_functions = *shading_instructions()[0].functions;

}  // namespace deburr
#endif
