#include "polygonizer/triage/simple_cell.hpp"

#include <algorithm>

#include "polygonizer/triage/density_side.hpp"
#include "polygonizer/triage/parallel_family.hpp"

namespace deburr {
namespace {

// Finds a unit direction in which ρ falls at all corners and the centre where it changes at all; false if none was
// found.
bool falling_direction(const LocalDensity& density, const std::vector<Vec3>& corners, Vec3& direction) {
    thread_local std::vector<Vec3> down;  // unit directions of steepest descent
    down.clear();
    Vec3 center(0.0), sum(0.0);
    const auto ask = [&](Vec3 x) {
        const Vec3 gradient = density.gradient_at(x).gradient;
        const double slope = glm::length(gradient);
        if (!(slope > 0)) return;
        down.push_back(-gradient / slope);
        sum += down.back();
    };
    for (const Vec3& x : corners) {
        ask(x);
        center += x / double(corners.size());
    }
    ask(center);
    // The perceptron rule: the direction that agrees least is added. A few steps find a direction unless the gradients
    // span nearly a half-space.
    constexpr int steps = 12;
    for (int k = 0; k < steps; ++k) {
        const double length = glm::length(sum);
        if (!(length > 0)) return false;
        direction = sum / length;
        double least = infinity;
        Vec3 worst(0.0);
        for (const Vec3& d : down) {
            const double agreement = glm::dot(d, direction);
            if (agreement >= least) continue;
            least = agreement;
            worst = d;
        }
        constexpr double enough = 0.05;  // cosine
        if (least > enough) return true;
        sum = direction * double(down.size()) + worst * (double(down.size()) * (enough - least));
    }
    return false;
}

// Whether the field provably only falls in the direction over the box: by its rate over all of it, or over its eighths.
bool falls(const Field& field, const Box& box, Vec3 direction, int depth) {
    const Range rate = field.rate_range(box, direction);
    if (rate.hi <= 0) return true;
    if (depth == 0 || rate.lo + rate.hi >= 0) return false;
    const Vec3 middle = 0.5 * (box.lo + box.hi);
    for (int part = 0; part < 8; ++part) {
        Box eighth = box;
        for (int k = 0; k < 3; ++k) ((part >> k & 1) != 0 ? eighth.lo : eighth.hi)[k] = middle[k];
        if (!falls(field, eighth, direction, depth - 1)) return false;
    }
    return true;
}

}  // namespace

bool is_simple(const LocalDensity& density, const std::vector<Vec3>& corners, double tolerance) {
    Vec3 direction;
    if (!falling_direction(density, corners, direction)) return false;
    if (const Field* field = density.field()) {
        Box box;
        for (const Vec3& x : corners) box = hull(box, Box{x, x});
        constexpr int depth = 1;
        return falls(*field, box, direction, depth);
    }
    thread_local std::vector<Range> rho, rates;
    rho.clear();
    rates.clear();
    for (const HalfSpace& h : density.half_spaces()) {
        Range s = extent_along(h.normal, corners);
        s = {s.lo - h.offset, s.hi - h.offset};
        rho.push_back(rho_between(h, s.lo, s.hi, tolerance));
        if (!varies(rho.back())) {
            rates.push_back({0, 0});
            continue;
        }
        if (h.radius == 0) return false;
        // dρ/dα = −¾(1 − α²) is least where |α| is least.
        const double lo = s.lo / h.radius, hi = s.hi / h.radius;
        const double nearest = lo > 0 ? lo : hi < 0 ? hi : 0, farthest = std::max(-lo, hi);
        const Range slope{profile_slope(nearest), profile_slope(farthest)};
        const double rate = glm::dot(h.normal, direction) / h.radius;
        rates.push_back(rate > 0 ? Range{slope.lo * rate, slope.hi * rate} : Range{slope.hi * rate, slope.lo * rate});
    }
    // Where opposite walls cancel, the sum of their rates is off by rounding.
    double steepest = 0;
    for (const Range& rate : rates) steepest = std::max({steepest, -rate.lo, rate.hi});
    return density.rate_range(rho, rates).hi <= 1e-12 * steepest;
}

}  // namespace deburr
