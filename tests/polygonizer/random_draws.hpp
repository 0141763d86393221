// Random numbers that are the same with every compiler, and random rotations: the base of the random solids.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>

#include "bounds/vec.hpp"

namespace deburr {

/// Rotation by `angle` radians about the axis through the origin along the unit vector `axis`.
inline Affine turn_about(Vec3 axis, double angle) {
    Affine map;
    for (int k = 0; k < 3; ++k) {
        Vec3 e(0.0);
        e[k] = 1;
        map.linear[k] = e * std::cos(angle) + glm::cross(axis, e) * std::sin(angle) +
                        axis * (glm::dot(axis, e) * (1 - std::cos(angle)));
    }
    return map;
}

class RandomDraws {
protected:
    explicit RandomDraws(std::uint64_t seed) : random_(seed) {}
    /// A seed for `number`; neighbouring numbers get seeds that are far apart.
    static std::uint64_t spread(int number) {
        return std::uint64_t(number) * 6364136223846793005u + 1442695040888963407u;
    }

    int below(int n) { return int(random_() % std::uint64_t(n)); }
    double unit() { return double(random_() >> 11) * 0x1p-53; }
    /// A rotation about a random axis, followed by a translation of 0 to 100 along x.
    Affine turn() {
        const Vec3 axis = glm::normalize(Vec3(unit() - 0.5, unit() - 0.5, unit() - 0.5) + Vec3(1e-3));
        const double angle = 6.283185307179586 * unit();
        Affine map = turn_about(axis, angle);
        map.shift = Vec3(100 * unit(), 0, 0);
        return map;
    }

private:
    std::mt19937_64 random_;
};

}  // namespace deburr
