// Samples of pixels, the pixel filter, and rays of the camera.
#include "raytracer/render/sampler.hpp"

#include <set>

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"

using namespace deburr;

TEST_CASE("Samples are a (0, m, 2)-net: every elementary box of 2^m points holds one") {
    int boxes = 0;
    for (int m = 0; m <= 8; ++m)
        for (std::uint32_t dimension : {0u, 1u, 1024u, 0xffffffffu})
            for (int k = 0; k <= m; ++k) {
                CAPTURE(m, dimension, k);
                std::set<std::pair<int, int>> seen;
                for (int s = 0; s < 1 << m; ++s) {
                    const Vec2 u = Sampler(5, 31, 17, s).square(dimension);
                    REQUIRE((u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1));
                    seen.insert({int(u.x * (1 << k)), int(u.y * (1 << (m - k)))});
                }
                CHECK(int(seen.size()) == 1 << m);
                boxes += int(seen.size());
            }
    CHECK(boxes > 4 * 9 * 256);
}

TEST_CASE("Neighbouring pixels' samples are a (0, m, 2)-net together, for every power of two of them") {
    long boxes = 0;
    for (int level = 0; level <= Sampler::block_levels; ++level)
        for (int m = 0; m + 2 * level <= 12; ++m)
            for (std::uint32_t dimension : {0u, 3u, 1024u})
                for (int k = 0; k <= m + 2 * level; ++k) {
                    CAPTURE(level, m, dimension, k);
                    const int side = 1 << level, count = m + 2 * level;
                    std::set<std::pair<int, int>> seen;
                    for (int s = 0; s < 1 << m; ++s)
                        for (int pixel = 0; pixel < side * side; ++pixel) {
                            const Vec2 u =
                                Sampler(5, 5 * side + pixel % side, 3 * side + pixel / side, s).square(dimension);
                            seen.insert({int(u.x * (1 << k)), int(u.y * (1 << (count - k)))});
                        }
                    CHECK(int(seen.size()) == 1 << count);
                    boxes += long(seen.size());
                }
    CHECK(boxes == 1468071);
}

TEST_CASE("Parts of samples are stratified together") {
    std::set<std::pair<int, int>> seen;
    for (int s = 0; s < 16; ++s)
        for (int k = 0; k < 16; ++k) {
            const Vec2 u = Sampler(5, 3, 4, s).square(9, k, 16);
            seen.insert({int(u.x * 16), int(u.y * 16)});
        }
    CHECK(seen.size() == 256);
}

TEST_CASE("Seed, pixel, sample and dimension each change a sample, in every bit evenly") {
    const Vec2 u = Sampler(1, 2, 3, 4).square(5);
    CHECK(u == Sampler(1, 2, 3, 4).square(5));
    for (std::uint32_t d = 0; d < 100; ++d) CHECK(Sampler(1, 2, 3, 7).line(d) == Sampler(1, 2, 3, 7).square(d).x);
    for (const Vec2& other :
         {Sampler(2, 2, 3, 4).square(5), Sampler(1, 3, 3, 4).square(5), Sampler(1, 2, 4, 4).square(5),
          Sampler(1, 3, 2, 4).square(5), Sampler(1, 2, 3, 5).square(5), Sampler(1, 2, 3, 4).square(6)})
        CHECK((u.x != other.x && u.y != other.y));
    // Over all pixels a sample is uniform within five standard deviations, 1/√n = 0.004 each, and uncorrelated with its
    // neighbour's.
    const int side = 256, n = side * side;
    double product = 0, product_xy = 0;
    std::vector<int> ones(32);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Vec2 a = Sampler(1, x, y, 0).square(0), b = Sampler(1, x + 1, y, 0).square(0);
            product += (a.x - 0.5) * (b.x - 0.5) * 12 / n;
            product_xy += (a.x - 0.5) * (a.y - 0.5) * 12 / n;
            const auto bits = std::uint32_t(a.x * 0x1p32) ^ std::uint32_t(a.y * 0x1p32);
            for (int k = 0; k < 32; ++k) ones[k] += (bits >> k) & 1;
        }
    CHECK(product < -0.1);
    CHECK(std::abs(product_xy) < 0.02);
    for (int count : ones) CHECK(std::abs(2.0 * count / n - 1) < 0.02);
}

TEST_CASE("The filter has unit area, is positive, and offsets are distributed like it") {
    double area = 0, variance = 0;
    const int n = 4096;
    for (int i = 0; i < n; ++i) {
        const double x = filter_radius * (2 * (i + 0.5) / n - 1);
        REQUIRE(filter_value(x) > 0);
        area += filter_value(x) * 2 * filter_radius / n;
        variance += x * x * filter_value(x) * 2 * filter_radius / n;
    }
    CHECK(area == Approx(1).epsilon(1e-12));
    CHECK(filter_value(filter_radius) == 0);

    constexpr int bins = 30;
    std::vector<double> share(bins);
    double mean = 0, spread = 0, widest = 0;
    for (int i = 0; i < n; ++i) {
        const double x = filter_offset({(i + 0.5) / n, 0.0}).x;
        mean += x / n;
        spread += x * x / n;
        widest = std::max(widest, std::abs(x));
        share[(x / filter_radius + 1) * bins / 2] += 1.0 / n;
    }
    CHECK(std::abs(mean) < 1e-6);
    CHECK(spread == Approx(variance).epsilon(0.002));
    CHECK(widest < filter_radius);
    for (int b = 0; b < bins; ++b) {
        double expected = 0;
        for (int k = 0; k < 100; ++k)
            expected +=
                filter_value(filter_radius * (2 * (b + (k + 0.5) / 100) / bins - 1)) * 2 * filter_radius / (100 * bins);
        CHECK(share[b] == Approx(expected).margin(1.5 / n));
    }
}

TEST_CASE("The camera's conventions: centres, up, right, field of view") {
    const Camera camera{{1, 2, 3}, {1, 2, -7}, {0, 1, 0}, 60};
    const ProjectiveCamera view(camera, 400, 200);
    CHECK(close(view.forward(), {0, 0, -1}, 0));
    CHECK(close(view.ray(200, 100).direction, {0, 0, -1}, 1e-15));
    CHECK(view.ray(200, 100).origin == camera.eye);
    // The top and bottom of the picture are half of the field of view up and down; y = 0 is the top.
    const Vec3 top = view.ray(200, 0).direction, bottom = view.ray(200, 200).direction;
    CHECK(std::atan2(top.y, -top.z) * 180 / pi == Approx(30).epsilon(1e-13));
    CHECK(std::atan2(bottom.y, -bottom.z) * 180 / pi == Approx(-30).epsilon(1e-13));
    // Pixels are square and x points right; the picture is twice as wide as high.
    const Vec3 right = view.ray(400, 100).direction;
    CHECK(right.x / -right.z == Approx(2 * std::tan(pi / 6)).epsilon(1e-13));
    CHECK(glm::length(view.ray(13.5, 77.5).direction) == Approx(1).epsilon(1e-15));
}

TEST_CASE("A camera without a view or an up still has rays") {
    int cameras = 0;
    for (const Camera& camera :
         {Camera{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 40}, Camera{{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 40},
          Camera{{0, 0, 0}, {0, 0, -1}, {0, 0, 0}, 40}, Camera{{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, 40}}) {
        const ProjectiveCamera view(camera, 10, 10);
        const Vec3 a = view.ray(0, 0).direction, b = view.ray(10, 10).direction;
        CHECK(glm::length(a) == Approx(1));
        CHECK(glm::dot(a, view.forward()) == Approx(glm::dot(b, view.forward())));
        CHECK(glm::dot(a, b) < 0.9);
        ++cameras;
    }
    CHECK(cameras == 4);
}
