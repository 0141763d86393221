// Bounds over a box on the rate at which a density changes in a given direction.
#include "bounds/local_density.hpp"
#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

// Ranges over the box of each half-space's ρ and of its rate of change along `direction`.
void half_space_ranges(const LocalDensity& density, const Box& box, Vec3 direction, std::vector<Range>& rho,
                       std::vector<Range>& rates) {
    rho.clear();
    rates.clear();
    for (const HalfSpace& h : density.half_spaces()) {
        rho.push_back(density_range(h, box));
        const Range d = distance_range(h, box);
        const double lo = d.lo / h.radius, hi = d.hi / h.radius, nearest = lo > 0 ? lo : hi < 0 ? hi : 0;
        const double steepest = profile_slope(nearest), flattest = profile_slope(std::max(-lo, hi));
        const double rate = glm::dot(h.normal, direction) / h.radius;
        rates.push_back({std::min(steepest * rate, flattest * rate), std::max(steepest * rate, flattest * rate)});
    }
}

}  // namespace

TEST_CASE("a density's rate in a direction lies in its range over the box") {
    int one_sign = 0, changing = 0;
    std::vector<Range> rho, rates;
    for (auto seed : seeds(6'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double radius = g.between(0.05, 0.5);
        const DensityTree tree = flatten(g.chance(0.5) ? g.boolean(2) : g.arithmetic(2), radius);
        const Vec3 middle = g.near(tree);
        const Vec3 half(g.between(0.01, 0.3) * radius);
        const Box box{middle - half, middle + half};
        const Pruned local = prune(tree, box);
        const LocalDensity density(local.tree);
        const auto& planes = density.half_spaces();
        if (std::any_of(planes.begin(), planes.end(), [](const HalfSpace& h) { return h.radius == 0; })) continue;
        const Vec3 direction = g.direction();
        half_space_ranges(density, box, direction, rho, rates);
        const Range range = density.rate_range(rho, rates);
        one_sign += range.hi < 0 || range.lo > 0;
        for (int k = 0; k < 6; ++k) {
            const Vec3 x = middle + Vec3(g.between(-1, 1), g.between(-1, 1), g.between(-1, 1)) * half;
            const double rate = glm::dot(density.gradient_at(x).gradient, direction);
            REQUIRE(rate >= range.lo - 1e-11 / radius);
            REQUIRE(rate <= range.hi + 1e-11 / radius);
            changing += rate != 0;
        }
    }
    CHECK(changing > 5'000);
    CHECK(one_sign > 500);
}

TEST_CASE("a true convolution's rate has the sign that its half-spaces give it") {
    int one_sign = 0;
    std::vector<Range> rho, rates;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double radius = 0.3;
        const LocalDensity density(flatten_convolved(
            Density::box(Vec3(0.0), Vec3(1.0)) & ~Density::box({0.2, 0.3, -1}, {0.7, 0.6, 2}), radius));
        const Vec3 middle = Vec3(g.number(), g.number(), g.number());
        const Box box{middle - Vec3(0.02), middle + Vec3(0.02)};
        const Vec3 direction = g.direction();
        half_space_ranges(density, box, direction, rho, rates);
        const Range range = density.rate_range(rho, rates);
        one_sign += range.hi <= 0 || range.lo >= 0;
        for (int k = 0; k < 4; ++k) {
            const Vec3 x = middle + Vec3(g.between(-1, 1), g.between(-1, 1), g.between(-1, 1)) * 0.02;
            const double rate = glm::dot(density.gradient_at(x).gradient, direction);
            REQUIRE(rate >= range.lo - 1e-9);
            REQUIRE(rate <= range.hi + 1e-9);
        }
    }
    CHECK(one_sign > 20);
}
