// The density profile of a half-space and its inverse, the displacement.
#include "bounds/profile.hpp"

#include <bit>
#include <cmath>
#include <vector>

#include "bounds/clamped_alpha.hpp"
#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

TEST_CASE("Lobb eq. 2: the profile falls from 1 to 0 and its slope is its derivative") {
    CHECK(profile(-1) == 1);
    CHECK(profile(1) == 0);
    CHECK(profile(0) == 0.5);
    CHECK(profile(-infinity) == 1);
    CHECK(profile(infinity) == 0);
    double last = 1;
    for (int i = -2000; i <= 2000; ++i) {
        const double a = i / 1000.0, h = 1e-6;
        CHECK(profile(a) <= last);
        last = profile(a);
        if (std::abs(std::abs(a) - 1) > 0.001)
            CHECK(std::abs((profile(a + h) - profile(a - h)) / (2 * h) - profile_slope(a)) < 1e-9);
    }
}

TEST_CASE("clamping without branches is clamping, to the bit, of one and of two") {
    std::vector<double> all{-infinity, -1.0, -0.0, 0.0, 1.0, infinity};
    for (const double edge : {-1.0, 1.0}) {
        all.push_back(std::nextafter(edge, -infinity));
        all.push_back(std::nextafter(edge, infinity));
    }
    Gen g(1);
    for (int i = 0; i < 1'000; ++i) all.push_back(g.between(-3, 3));
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double a = all[i], b = all[all.size() - 1 - i];
        CAPTURE(a, b);
        REQUIRE(bits(clamped_alpha(a)) == bits(std::clamp(a, -1.0, 1.0)));
        const DoublePair pair = clamped_alpha(DoublePair{a, b});
        REQUIRE(bits(pair[0]) == bits(std::clamp(a, -1.0, 1.0)));
        REQUIRE(bits(pair[1]) == bits(std::clamp(b, -1.0, 1.0)));
    }
}

TEST_CASE("Lobb §3.3: displacement inverts the profile to within its slack, monotonically") {
    constexpr int steps = 2'000'000;
    double last = 1, worst = 0;
    int out_of_order = 0;
    for (int i = 0; i <= steps; ++i) {
        const double rho = double(i) / steps, a = displacement(rho);
        worst = std::max(worst, std::abs(profile(a) - rho));
        out_of_order += a > last;
        last = a;
    }
    CHECK(worst < inverse_slack);
    CHECK(out_of_order == 0);
    CHECK(displacement(0) == 1);
    CHECK(displacement(0.5) == 0);
    CHECK(displacement(1) == -1);
    CHECK(displacement(-1) == 1);
    CHECK(displacement(2) == -1);
}

TEST_CASE("displacement stays in [-1, 1], monotone and accurate where the cubic is flat") {
    double last = 1;
    int checked = 0;
    for (double rho = 1e-300; rho < 0.1; rho *= 1.07, ++checked) {
        CAPTURE(rho);
        const double a = displacement(rho), b = displacement(1 - rho);
        REQUIRE(a <= last);
        last = a;
        REQUIRE(std::abs(profile(a) - rho) <= inverse_slack);
        REQUIRE(std::abs(profile(b) - (1 - rho)) <= inverse_slack);
        // To first order 1 − α is √(4ρ/3); the cosine formula as printed loses it to cancellation.
        if (rho < 1e-6 && rho > 1e-24) REQUIRE(std::abs((1 - a) / std::sqrt(4 * rho / 3) - 1) < 1e-3);
    }
    CHECK(checked > 9'000);
}
