// A free form along a ray: with u = t − middle every Q is a + b·u + c·u², and F is
//
//     F(u) = base(u) + Σ fᵢ max(0, Qᵢ(u))³
//
// Over a segment, the base and the perturbations that are positive throughout add up to one polynomial of degree six.
// Its derivatives are bounded by their Bernstein coefficients over the segment, so what cancels in F cancels in the
// bounds. For a perturbation that begins or ends in the segment, with 0 ≤ Q ≤ q and |Q′| ≤ d there, |R′| ≤ 3q²d and
// |R″| ≤ 6qd² + 3q²|Q″|; q is small in short segments.
#include <algorithm>
#include <array>

#include "bounds/free_form.hpp"

namespace deburr {
namespace {

struct Quadratic {
    double a, b, c;  // a + b·u + c·u²
    double at(double u) const { return a + u * (b + u * c); }
    double slope(double u) const { return b + 2 * u * c; }
};

/// Q(x + u·d) as a polynomial in u.
Quadratic along(const Quadric& q, Vec3 x, Vec3 d) {
    const Vec3 Ad = q.A * d;
    return {q.at(x), glm::dot(d, q.b) + 2 * glm::dot(Ad, x - q.center), glm::dot(d, Ad)};
}

// ray.numbers holds middle; a, b, c of the base; then f, a, b, c of each perturbation.
constexpr std::size_t first_perturbation = 4, stride = 4;

Quadratic quadratic(const double* n) { return {n[0], n[1], n[2]}; }

// The greatest absolute Bernstein coefficient of Σ c[k] s^k over [0, 1].
template <std::size_t count>
double bernstein_bound(const std::array<double, count>& c) {
    static constexpr auto share = [] {  // share[j][k]: weight of power k in coefficient j
        std::array<std::array<double, count>, count> table{};
        for (std::size_t j = 0; j < count; ++j) {
            double part = 1;
            for (std::size_t k = 0; k <= j; ++k) {
                table[j][k] = part;
                part *= double(j - k) / double(count - 1 - k ? count - 1 - k : 1);
            }
        }
        return table;
    }();
    double most = 0;
    for (std::size_t j = 0; j < count; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k <= j; ++k) sum += share[j][k] * c[k];
        most = std::max(most, std::abs(sum));
    }
    return most;
}

// A perturbation's contribution to the noise scale, if its Q is at most `most` and the absolute terms of Q add up to
// `magnitude`.
double noise_scale_of(const Perturbation& p, double most, double magnitude) {
    return 3 * std::abs(p.factor) * most * most * magnitude;
}

// The largest t where q = 0; −infinity if there is none.
double last_root(const Quadratic& q) {
    if (q.c == 0) return q.b == 0 ? -infinity : -q.a / q.b;
    const double discriminant = q.b * q.b - 4 * q.a * q.c;
    if (!(discriminant >= 0)) return -infinity;
    const double h = -0.5 * (q.b + std::copysign(std::sqrt(discriminant), q.b));
    const double one = h / q.c, two = h != 0 ? q.a / h : -infinity;
    return std::max(one, two);
}

}  // namespace

double FreeForm::last_sign_change_bound(Vec3 origin, Vec3 direction) const {
    if (box_.finite()) return leaves_box(box_, origin, direction);
    // Beyond the last root of every quadric F is one polynomial, beyond the bound of whose roots it keeps its sign.
    const Quadratic base = along(base_, origin, direction);
    double last = 0;
    std::array<double, 7> sum{base.a, base.b, base.c, 0, 0, 0, 0};
    for (const Perturbation& p : perturbations_) {
        const Quadratic q = along(p.quadric, origin, direction);
        const double own = last_root(q);
        if (std::isfinite(own)) last = std::max(last, own);
        const auto [a, b, c] = q;
        if (!(c > 0 || (c == 0 && b > 0) || (c == 0 && b == 0 && a > 0))) continue;
        const double terms[7] = {
            a * a * a,     3 * a * a * b, 3 * a * (a * c + b * b), b * (b * b + 6 * a * c), 3 * c * (a * c + b * b),
            3 * b * c * c, c * c * c};
        for (std::size_t k = 0; k < 7; ++k) sum[k] += p.factor * terms[k];
    }
    std::size_t degree = 6;
    while (degree > 0 && sum[degree] == 0) --degree;
    double bound = 0;  // Fujiwara's bound is tighter than Cauchy's
    for (std::size_t k = 0; k < degree; ++k)
        bound = std::max(bound, std::pow(std::abs(sum[k] / sum[degree]), 1.0 / double(degree - k)));
    return std::max(last, 2 * bound);
}

void FreeForm::begin_ray(FieldRay& ray) const {
    const double middle = 0.5 * (ray.t0 + ray.t1), half = 0.5 * (ray.t1 - ray.t0);
    const Vec3 x = ray.origin + ray.direction * middle, reach = glm::abs(ray.direction) * half;
    const auto magnitude = [&](const Quadric& q) { return q.magnitude(glm::abs(x - q.center) + reach); };
    auto& n = ray.numbers;
    n.clear();
    const Quadratic base = along(base_, x, ray.direction);
    n.insert(n.end(), {middle, base.a, base.b, base.c});
    double noise_scale = magnitude(base_);
    for (const Perturbation& p : perturbations_) {
        const Quadratic q = along(p.quadric, x, ray.direction);
        double most = std::max(q.at(-half), q.at(half));
        if (q.c < 0 && std::abs(q.b) < -2 * q.c * half) most = q.a - q.b * q.b / (4 * q.c);
        if (!(most > 0)) continue;
        n.insert(n.end(), {p.factor, q.a, q.b, q.c});
        noise_scale += noise_scale_of(p, most, magnitude(p.quadric));
    }
    if (noise_scale > 0) ray.noise_scale = noise_scale;
    const double scale = 1 / ray.noise_scale;
    for (std::size_t i = 1; i < first_perturbation; ++i) n[i] *= scale;
    for (std::size_t i = first_perturbation; i < n.size(); i += stride) n[i] *= scale;
}

double FreeForm::max_noise_scale(const Box& box) const {
    const auto magnitude = [&](const Quadric& q) {
        return q.magnitude(glm::max(glm::abs(box.lo - q.center), glm::abs(box.hi - q.center)));
    };
    double noise_scale = magnitude(base_);
    for (const Perturbation& p : perturbations_) {
        const double most = p.quadric.range(box).hi;
        if (most > 0) noise_scale += noise_scale_of(p, most, magnitude(p.quadric));
    }
    return noise_scale > 0 ? noise_scale : 1;
}

ValueSlope FreeForm::at(const FieldRay& ray, double t) const {
    const auto& n = ray.numbers;
    const double u = t - n[0];
    const Quadratic base = quadratic(&n[1]);
    ValueSlope sum{base.at(u), base.slope(u)};
    for (std::size_t i = first_perturbation; i < n.size(); i += stride) {
        const Quadratic q = quadratic(&n[i + 1]);
        const double value = q.at(u);
        if (!(value > 0)) continue;
        const double square = n[i] * value * value;
        sum.value += square * value;
        sum.slope += 3 * square * q.slope(u);
    }
    return sum;
}

RayBounds FreeForm::bounds(const FieldRay& ray, double t0, double t1) const {
    const auto& n = ray.numbers;
    const double u = t0 - n[0], length = t1 - t0;
    const auto local = [&](const double* from) {  // the quadratic as a function of s in [0, 1]
        const Quadratic q = quadratic(from);
        return Quadratic{q.at(u), q.slope(u) * length, q.c * length * length};
    };
    const Quadratic base = local(&n[1]);
    std::array<double, 7> sum{base.a, base.b, base.c, 0, 0, 0, 0};
    double M = 0, L = 0, G = 0;  // of perturbations that begin or end in the segment
    bool cubes = false;
    for (std::size_t i = first_perturbation; i < n.size(); i += stride) {
        const Quadratic q = local(&n[i + 1]);
        const auto [a, b, c] = q;
        const double end = a + b + c;
        double lo = std::min(a, end), hi = std::max(a, end);
        if (std::abs(b) < 2 * std::abs(c) && b * c < 0) {
            const double vertex = a - b * b / (4 * c);
            lo = std::min(lo, vertex);
            hi = std::max(hi, vertex);
        }
        if (hi <= 0) continue;
        const double f = n[i];
        if (lo >= 0) {
            cubes = true;
            const double aa = a * a, bb = b * b, cc = c * c;
            const double terms[7] = {
                aa * a,     3 * aa * b, 3 * a * (a * c + bb), b * (bb + 6 * a * c), 3 * c * (a * c + bb),
                3 * b * cc, cc * c};
            for (std::size_t k = 0; k < 7; ++k) sum[k] += f * terms[k];
        } else {
            const double slope = std::max(std::abs(b), std::abs(b + 2 * c));
            M += std::abs(f) * hi * hi * hi;
            L += std::abs(f) * 3 * hi * hi * slope;
            G += std::abs(f) * (6 * hi * slope * slope + 6 * hi * hi * std::abs(c));
        }
    }
    if (cubes) {
        std::array<double, 6> first;
        std::array<double, 5> second;
        for (std::size_t k = 0; k < 6; ++k) first[k] = double(k + 1) * sum[k + 1];
        for (std::size_t k = 0; k < 5; ++k) second[k] = double(k + 1) * first[k + 1];
        M += bernstein_bound(sum);
        L += bernstein_bound(first);
        G += bernstein_bound(second);
    } else {
        M += std::max(std::abs(sum[0]), std::abs(sum[0] + sum[1] + sum[2])) + std::abs(sum[2]);
        L += std::max(std::abs(sum[1]), std::abs(sum[1] + 2 * sum[2]));
        G += 2 * std::abs(sum[2]);
    }
    return {M, L / length, G / (length * length)};
}

}  // namespace deburr
