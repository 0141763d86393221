#include "polygonizer/triage/parallel_family.hpp"

#include <algorithm>

namespace deburr {
namespace {

constexpr double same_direction = 1e-9;  // sine of the angle between normals

}  // namespace

bool is_parallel_family(const LocalDensity& density) {
    const auto& planes = density.half_spaces();
    if (planes.empty() || density.field()) return false;
    for (const HalfSpace& h : planes)
        if (glm::length(glm::cross(h.normal, planes[0].normal)) > same_direction) return false;
    return true;
}

bool is_swept(const LocalDensity& density, Vec3& direction) {
    if (density.field()) {
        const std::optional<Vec3> sweep = density.field()->swept_along();
        if (sweep) direction = *sweep;
        return sweep.has_value();
    }
    const auto& planes = density.half_spaces();
    double best = same_direction;
    for (const HalfSpace& h : planes) {
        const Vec3 c = glm::cross(planes[0].normal, h.normal);
        if (glm::length(c) <= best) continue;
        best = glm::length(c);
        direction = glm::normalize(c);
    }
    if (best <= same_direction) return false;
    for (const HalfSpace& h : planes)
        if (std::abs(glm::dot(h.normal, direction)) > same_direction) return false;
    return true;
}

Range extent_along(Vec3 normal, const std::vector<Vec3>& points) {
    Range s{infinity, -infinity};
    for (const Vec3& x : points) {
        const double at = glm::dot(normal, x);
        s = {std::min(s.lo, at), std::max(s.hi, at)};
    }
    return s;
}

LevelPlanes level_planes(const LocalDensity& density, Range s, double tolerance) {
    const Vec3 n = density.half_spaces()[0].normal;
    s = {s.lo + tolerance, s.hi - tolerance};
    std::vector<double> own, knots{s.lo, s.hi};
    for (const HalfSpace& h : density.half_spaces()) {
        const double at = h.offset * (glm::dot(h.normal, n) > 0 ? 1 : -1);
        own.push_back(at);
        for (const double knot : {at - h.radius, at, at + h.radius})
            if (knot > s.lo && knot < s.hi) knots.push_back(knot);
    }
    std::sort(knots.begin(), knots.end());
    // Between knots ρ is a polynomial of low degree. Samples are denser near knots, because a level plane is often
    // displaced only a little from its half-space's own plane.
    constexpr double shares[] = {0, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 1};
    LevelPlanes result;
    double last_s = 0;
    int last_sign = 0;
    const auto sign = [&](double at) {
        const double f = density.at(n * at) - 0.5;
        return std::abs(f) < 1e-13 ? 0 : f > 0 ? 1 : -1;
    };
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        if (knots[k + 1] - knots[k] <= 2 * tolerance) continue;
        for (const double share : shares) {
            const double at = knots[k] + share * (knots[k + 1] - knots[k]);
            const int here = sign(at);
            if (here == 0) continue;
            if (last_sign != 0 && here != last_sign) {
                double a = last_s, b = at;
                while (b - a > 1e-15 * (std::abs(a) + std::abs(b))) {
                    const double middle = 0.5 * (a + b);
                    if (middle <= a || middle >= b) break;
                    (sign(middle) == last_sign ? a : b) = middle;
                }
                double root = b;
                for (const double plane : own)
                    if (std::abs(plane - root) <= tolerance) root = plane;
                if (root > s.lo && root < s.hi) result.planes.push_back({n, root});
            }
            last_sign = here;
            last_s = at;
        }
    }
    result.inside = last_sign > 0;
    return result;
}

}  // namespace deburr
