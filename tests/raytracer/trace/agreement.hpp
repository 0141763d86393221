// Distances of hits held against the plain definition.
#pragma once
#include <cmath>

#include "plain_definition.hpp"

namespace deburr {

/// The largest error of a distance: half of what users are promised.
constexpr double distance_tolerance = 1e-5;

inline bool agree(double t, double want) { return t == want || std::abs(t - want) < distance_tolerance; }

/// The first crossing on a ray by the definition. Its samples may step over a sliver, so that a nearer crossing that
/// was `found` is right if the definition changes sides there.
inline double expected_hit(const SolidTree& tree, Vec3 origin, Vec3 direction, double found, double t_max, int steps) {
    const double want = plain::first_crossing(tree, origin, direction, t_max, steps);
    const auto side = [&](double t) { return plain::contains(tree, origin + direction * t); };
    return found < want && side(found - 1e-7) != side(found + 1e-7) ? found : want;
}

struct Agreement {
    int rays = 0, hits = 0, differ = 0;
};

}  // namespace deburr
