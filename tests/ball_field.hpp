// The simplest field, f = 1 − |x|²: positive inside the unit ball.
#pragma once
#include "bounds/field.hpp"

namespace deburr {

class BallField final : public Field {
public:
    ValueGradient at(Vec3 x) const override { return {1 - glm::dot(x, x), -2.0 * x}; }
    Range range(const Box& box) const override {
        double nearest = 0, farthest = 0;
        for (int k = 0; k < 3; ++k) {
            const double a = std::abs(box.lo[k]), b = std::abs(box.hi[k]);
            if (box.lo[k] > 0 || box.hi[k] < 0) nearest += std::min(a * a, b * b);
            farthest += std::max(a * a, b * b);
        }
        return {1 - farthest, 1 - nearest};
    }
    Box bounding_box() const override { return {Vec3(-1), Vec3(1)}; }
    double last_sign_change_bound(Vec3 origin, Vec3 direction) const override {
        return leaves_box(bounding_box(), origin, direction);
    }
    void begin_ray(FieldRay& ray) const override {
        // f = a + b·u + c·u² with u = t − middle, divided by an upper bound of the sum of its terms' magnitudes
        const double middle = 0.5 * (ray.t0 + ray.t1), half = 0.5 * (ray.t1 - ray.t0);
        const Vec3 x = ray.origin + ray.direction * middle;
        const double xx = glm::dot(x, x), dx = glm::dot(ray.direction, x), dd = glm::dot(ray.direction, ray.direction);
        const double sum = 1 + xx + 2 * std::abs(dx) * half + dd * half * half;
        ray.noise_scale = sum;
        ray.numbers = {middle, (1 - xx) / sum, -2 * dx / sum, -dd / sum};
    }
    ValueSlope at(const FieldRay& ray, double t) const override {
        const auto& n = ray.numbers;
        const double u = t - n[0];
        return {n[1] + u * (n[2] + u * n[3]), n[2] + 2 * u * n[3]};
    }
    RayBounds bounds(const FieldRay& ray, double t0, double t1) const override {
        const ValueSlope a = at(ray, t0), b = at(ray, t1);
        return {1, std::max(std::abs(a.slope), std::abs(b.slope)), 2 * std::abs(ray.numbers[3])};
    }
};

}  // namespace deburr
