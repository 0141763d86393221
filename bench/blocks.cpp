#include "bench/blocks.hpp"

#include <algorithm>

namespace deburr::bench {
namespace {

double fraction(double x) { return x - std::floor(x); }

}  // namespace

std::vector<Solid> blocks(int count) {
    const int side = std::max(1, int(std::ceil(std::cbrt(count) - 1e-9)));
    const Solid block = Solid::rounded(0.08, Density::box(Vec3(-0.5), Vec3(0.5)));
    std::vector<Solid> solids;
    for (int i = 0; i < count; ++i) {
        const double a = 0.7 * i, c = std::cos(a), s = std::sin(a);
        solids.push_back(block.transformed({Mat3(0.6 * c, 0.6 * s, 0, -0.6 * s, 0.6 * c, 0, 0, 0, 0.6),
                                            Vec3(i % side, i / side % side, i / side / side)}));
    }
    return solids;
}

std::vector<Solid> different_blocks(int count) {
    const int side = std::max(1, int(std::ceil(std::cbrt(count) - 1e-9)));
    std::vector<Solid> solids;
    for (int i = 0; i < count; ++i) {
        const Vec3 half(0.25 + 0.1 * fraction(0.6180 * i), 0.25 + 0.1 * fraction(0.7549 * i), 0.3 + 1e-7 * i);
        solids.push_back(Solid::rounded(0.05, Density::box(-half, half))
                             .transformed({Mat3(1.0), Vec3(i % side, i / side % side, i / side / side)}));
    }
    return solids;
}

std::vector<Ray> rays_through(double side, int count) {
    std::vector<Ray> all;
    for (int n = 1; n <= count; ++n) {
        const Vec3 target = side * Vec3(fraction(0.8192 * n), fraction(0.6711 * n), fraction(0.5497 * n));
        const double phi = 6.2831853 * fraction(0.6180 * n), z = 2 * fraction(0.7549 * n) - 1;
        const Vec3 eye = Vec3(0.5 * side) +
                         2 * side * Vec3(std::cos(phi) * std::sqrt(1 - z * z), z, std::sin(phi) * std::sqrt(1 - z * z));
        all.push_back({eye, glm::normalize(target - eye)});
    }
    return all;
}

}  // namespace deburr::bench
