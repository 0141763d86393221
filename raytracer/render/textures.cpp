#include "raytracer/render/textures.hpp"

#include <cstdint>

#include "raytracer/render/image_map.hpp"

namespace deburr {
namespace {

// A surface in a wall between the checker's cubes belongs to the cube below it. Since positions have rounding errors
// (single precision through a mesh), the lookup is this fraction of a cube deeper.
constexpr double depth_of_lookup = 1.0 / 1024;

std::uint32_t hashed(std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t h = std::uint64_t(x) * 0x8da6b343u + std::uint64_t(y) * 0xd8163841u + std::uint64_t(z) * 0xcb1ab31fu;
    h = (h ^ (h >> 31)) * 0x9e3779b97f4a7c15u;
    return std::uint32_t((h ^ (h >> 29)) >> 16);
}

// Beyond this, doubles are integers; there, and for NaN, the noise is flat.
constexpr double lattice_end = 0x1p52;

std::int64_t lattice(double floor) { return std::abs(floor) < lattice_end ? std::int64_t(floor) : 0; }

// The value at offset d of the lattice point's linear function, whose gradient is one of the 12 edges of a cube.
double gradient(std::uint32_t h, Vec3 d) {
    const double signs[2] = {1.0, -1.0};
    const double a = signs[h & 1], b = signs[(h >> 1) & 1];
    switch ((h >> 2) % 3) {
        case 0: return a * d.x + b * d.y;
        case 1: return a * d.y + b * d.z;
        default: return a * d.z + b * d.x;
    }
}

double checker_parity(Vec3 x) {
    const Vec3 cell = glm::floor(x);
    return std::abs(std::fmod(cell.x + cell.y + cell.z, 2.0));
}

// Wood: concentric year rings, each light and then gradually darker until it ends abruptly; wavy by noise that is long
// along the trunk; with fine fibres. Lengths are in rings and were chosen by eye.
constexpr double waviness = 0.9, wave_length = 5.0, wave_stretch = 6.0;
constexpr double ripple = 0.12, ripple_length = 1.1, ripple_stretch = 5.0;
constexpr double fibre_width = 0.09, fibre_length = 2.4, fibre_depth = 0.22;
constexpr double pore_width = 0.035, pore_length = 0.8, pore_depth = 0.35;
constexpr double late_start = 0.25, late_full = 0.9, late_end = 0.985;

// A position relative to the texture's axis, perpendicular to it and along it, in its scale.
struct AxisPlace {
    Vec3 section;
    double along;
};

AxisPlace axis_place(const Texture& t, Vec3 p) {
    const Vec3 axis = glm::normalize(t.axis);
    const Vec3 side = std::abs(axis.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    const Vec3 across = glm::normalize(glm::cross(axis, side));
    const Vec3 away = glm::cross(axis, across);
    const Vec3 q = (p - t.origin) / t.scale;
    return {{glm::dot(q, across), glm::dot(q, away), 0}, glm::dot(q, axis)};
}

Vec3 wood(const Texture& t, Vec3 p) {
    const AxisPlace at = axis_place(t, p);
    auto grain = [&](double width, double length) {
        return noise({at.section.x / width, at.section.y / width, at.along / length});
    };

    const double radius = glm::length(at.section) + waviness * grain(wave_length, wave_length * wave_stretch) +
                          ripple * grain(ripple_length, ripple_length * ripple_stretch);
    const double ring = std::floor(radius), part = radius - ring;
    const double strength = 0.7 + 0.3 * (hashed(lattice(ring), 7, 11) & 0xffff) / 65535.0;
    const double late =
        strength * glm::smoothstep(late_start, late_full, part) * (1 - glm::smoothstep(late_end, 1.0, part));
    const double fibre = fibre_depth * grain(fibre_width, fibre_length);
    const double pore = pore_depth * glm::smoothstep(0.25, 0.6, grain(pore_width, pore_length));
    const double darkness = glm::clamp(late + fibre, 0.0, 1.0);
    return glm::mix(t.a, t.b, darkness) * (1 - pore * (1 - darkness));
}

// Noise with octaves − 1 layers more, each of half the size and strength of the one before; in [-1, 1].
double fractal(Vec3 x, int octaves) {
    double sum = 0, strength = 1, total = 0;
    for (int i = 0; i < octaves; ++i, x *= 2.0, strength *= 0.5) {
        sum += strength * noise(x);
        total += strength;
    }
    return sum / total;
}

// Marble: planes of veins, sharp and thin, bent by noise of this many octaves [after Perlin, An Image Synthesizer,
// 1985]. `bend` is in distances of veins; chosen by eye.
constexpr int bending_octaves = 6;
constexpr double bend = 1.5, bend_length = 1.5, vein_sharpness = 5;

double vein(const Texture& t, Vec3 p) {
    const Vec3 q = (p - t.origin) / t.scale;
    const double at = glm::dot(q, glm::normalize(t.axis)) +
                      (t.turbulence > 0 ? bend * t.turbulence * fractal(q / bend_length, bending_octaves) : 0.0);
    return std::pow(std::abs(std::cos(pi * at)), vein_sharpness);
}

// Streaks are this much longer than wide; around the axis they are rings, as on a lathe.
constexpr double streak_length = 100;
constexpr int streak_octaves = 2;

double streak(const Texture& t, Vec3 p) {
    const auto [section, along] = axis_place(t, p);
    const Vec3 q =
        t.around ? Vec3(glm::length(section), along, 0.5) : Vec3(section.x, section.y, along / streak_length + 0.5);
    return fractal(q, streak_octaves);
}

// Stretches noise, which rarely comes near -1 or 1.
constexpr double contrast = 1.6;
double share_of(double noise) { return glm::clamp(0.5 + 0.5 * contrast * noise, 0.0, 1.0); }

}  // namespace

double noise(Vec3 x) {
    const Vec3 cell = glm::floor(x), d = x - cell;
    const std::int64_t i = lattice(cell.x), j = lattice(cell.y), k = lattice(cell.z);
    const Vec3 s = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);  // two continuous derivatives
    auto corner = [&](int a, int b, int c) { return gradient(hashed(i + a, j + b, k + c), d - Vec3(a, b, c)); };
    auto edge = [&](int b, int c) { return glm::mix(corner(0, b, c), corner(1, b, c), s.x); };
    return glm::mix(glm::mix(edge(0, 0), edge(1, 0), s.y), glm::mix(edge(0, 1), edge(1, 1), s.y), s.z);
}

Vec3 pattern_color(const Texture& texture, Vec3 position, Vec3 normal) {
    switch (texture.kind) {
        case Texture::Kind::checker: {
            const Vec3 x = (position - texture.origin) / texture.scale - normal * depth_of_lookup;
            return checker_parity(x) == 0 ? texture.a : texture.b;
        }
        case Texture::Kind::wood: return wood(texture, position);
        case Texture::Kind::marble: return glm::mix(texture.a, texture.b, vein(texture, position));
        case Texture::Kind::noise: {
            const Vec3 x = (position - texture.origin) / texture.scale;
            return glm::mix(texture.a, texture.b, share_of(fractal(x, texture.octaves)));
        }
        case Texture::Kind::brushed: return glm::mix(texture.a, texture.b, share_of(streak(texture, position)));
        case Texture::Kind::image: return image_color(texture, position, normal);
        case Texture::Kind::constant: break;
    }
    return texture.a;
}

}  // namespace deburr
