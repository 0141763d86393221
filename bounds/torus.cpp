#include "bounds/torus.hpp"

#include <array>

#include "bounds/round_coordinate.hpp"

namespace deburr {
namespace {

// f along a ray is Σ c[k] u^k with u = t − middle. ray.numbers holds middle, c[0] … c[4].
constexpr int degree = 4;

double size_of(Vec3 v) { return glm::length(v); }

}  // namespace

Torus::Torus(Vec3 center, Vec3 axis, double radius, double tube)
    : center_(center), axis_(axis), radius_(radius), tube_(tube) {}

ValueGradient Torus::at(Vec3 x) const {
    const Vec3 y = x - center_, outward = y - axis_ * glm::dot(axis_, y);
    const double R = radius_, k = glm::dot(y, y) + R * R - tube_ * tube_;
    return {4 * R * R * glm::dot(outward, outward) - k * k, 8 * R * R * outward - 4 * k * y};
}

Range Torus::range(const Box& box) const {
    const RoundCoordinate circle = RoundCoordinate::distance_from_circle(center_, axis_, radius_),
                          opposite = RoundCoordinate::distance_from_circle(center_, axis_, -radius_);
    const Range q = circle.range(box), p = opposite.range(box);
    const double a = tube_ * tube_, far = std::max(0.0, p.hi * p.hi - a), near = std::max(0.0, p.lo * p.lo - a);
    const double most = a - q.lo * q.lo, least = a - q.hi * q.hi;
    return {least < 0 ? (far > 0 ? least * far : 0) : least * near, most > 0 ? most * far : most * near};
}

Box Torus::bounding_box() const {
    Vec3 half(tube_);
    for (int k = 0; k < 3; ++k) half[k] += radius_ * std::sqrt(std::max(0.0, 1 - axis_[k] * axis_[k]));
    return inflated({center_ - half, center_ + half}, 4 * epsilon * (largest(center_) + largest(half)));
}

FieldPtr Torus::transformed_by(const Affine& map) const {
    const double scale = even_scale(map);
    if (scale == 0) return nullptr;
    return std::make_shared<Torus>(map(center_), glm::normalize(map.linear * axis_), scale * radius_, scale * tube_);
}

double Torus::last_sign_change_bound(Vec3 origin, Vec3 direction) const {
    return leaves_box(bounding_box(), origin, direction);
}

double Torus::max_noise_scale(const Box& box) const {
    const double y = size_of(glm::max(glm::abs(box.lo - center_), glm::abs(box.hi - center_))), R = radius_;
    const double k = y * y + R * R + tube_ * tube_;
    return 4 * R * R * y * y + k * k;
}

void Torus::begin_ray(FieldRay& ray) const {
    const double middle = 0.5 * (ray.t0 + ray.t1), half = 0.5 * (ray.t1 - ray.t0);
    const Vec3 y = ray.origin + ray.direction * middle - center_, d = ray.direction;
    const Vec3 reach = glm::abs(y) + glm::abs(d) * half;
    const double R = radius_, far = size_of(reach), largest_k = far * far + R * R + tube_ * tube_;
    ray.noise_scale = 4 * R * R * far * far + largest_k * largest_k;
    const double yt = glm::dot(axis_, y), dt = glm::dot(axis_, d);
    const Vec3 ys = y - axis_ * yt, ds = d - axis_ * dt;
    const double k0 = glm::dot(y, y) + R * R - tube_ * tube_, k1 = 2 * glm::dot(y, d), k2 = glm::dot(d, d);
    const double scale = 1 / ray.noise_scale;
    ray.numbers.assign(
        {middle, scale * (4 * R * R * glm::dot(ys, ys) - k0 * k0), scale * (8 * R * R * glm::dot(ys, ds) - 2 * k0 * k1),
         scale * (4 * R * R * glm::dot(ds, ds) - 2 * k0 * k2 - k1 * k1), scale * (-2 * k1 * k2), scale * (-k2 * k2)});
}

ValueSlope Torus::at(const FieldRay& ray, double t) const {
    const double* c = &ray.numbers[1];
    const double u = t - ray.numbers[0];
    return {c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * c[4]))),
            c[1] + u * (2 * c[2] + u * (3 * c[3] + u * 4 * c[4]))};
}

RayBounds Torus::bounds(const FieldRay& ray, double t0, double t1) const {
    // Taylor expansion about the middle of the segment.
    const double u = 0.5 * (t0 + t1) - ray.numbers[0], h = 0.5 * (t1 - t0);
    std::array<double, degree + 1> c;
    for (int k = 0; k <= degree; ++k) c[std::size_t(k)] = ray.numbers[std::size_t(k) + 1];
    for (std::size_t k = 0; k < degree; ++k)
        for (std::size_t j = degree; j-- > k;) c[j] += u * c[j + 1];
    const auto sum = [&](const std::array<double, degree + 1>& of) {
        double total = 0, power = 1;
        for (const double x : of) {
            total += std::abs(x) * power;
            power *= h;
        }
        return total;
    };
    return {sum(c), sum({c[1], 2 * c[2], 3 * c[3], 4 * c[4], 0}), sum({2 * c[2], 6 * c[3], 12 * c[4], 0, 0})};
}

}  // namespace deburr
