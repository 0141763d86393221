// Simple cells: those that cannot hold a whole component of the surface.
#include "polygonizer/triage/simple_cell.hpp"

#include "bounds/bounding_box.hpp"
#include "catch.hpp"
#include "polygonizer/triage/triage.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

std::vector<Vec3> corners_of(const Box& b) {
    std::vector<Vec3> all;
    for (int k = 0; k < 8; ++k)
        all.push_back({k & 1 ? b.hi.x : b.lo.x, k & 2 ? b.hi.y : b.lo.y, k & 4 ? b.hi.z : b.lo.z});
    return all;
}

// Number of times that the segment ab crosses the surface, by 64 samples.
int crossings(const LocalDensity& density, Vec3 a, Vec3 b) {
    int count = 0;
    bool inside = density.at(a) > 0.5;
    constexpr int samples = 64;
    for (int k = 1; k <= samples; ++k) {
        const bool now = density.at(a + (b - a) * (k / double(samples))) > 0.5;
        count += now != inside;
        inside = now;
    }
    return count;
}

}  // namespace

TEST_CASE("A simple cell holds no part of the surface whole: from every point one can fall out of it") {
    int simple = 0, crossed = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double radius = g.between(0.1, 0.6);
        const DensityTree tree = flatten(g.boolean(2), radius);
        const Vec3 middle = g.near(tree), half(g.between(0.05, 0.6) * radius);
        const Box box{middle - half, middle + half};
        const LocalDensity density(prune(tree, box).tree);
        if (density.has_sharp() || !is_simple(density, corners_of(box), 1e-9)) continue;
        ++simple;
        // The density of a simple cell nearly always falls along the mean gradient, so lines in that direction cross at
        // most once.
        Vec3 down(0.0);
        for (const Vec3& x : corners_of(box)) down -= density.gradient_at(x).gradient;
        if (!(glm::length(down) > 0)) continue;
        for (int k = 0; k < 4; ++k) {
            const Vec3 x = middle + Vec3(g.between(-1, 1), g.between(-1, 1), g.between(-1, 1)) * half * 0.3;
            const Vec3 step = glm::normalize(down) * (0.6 * half.x);
            const int count = crossings(density, x - step, x + step);
            CHECK(count <= 1);
            crossed += count == 1;
        }
    }
    CHECK(simple > 500);
    CHECK(crossed > 100);
}

TEST_CASE("A cell around a small part of the surface is not simple") {
    // Rounding has nearly removed this cube; what is left of it is in its middle.
    const LocalDensity density(flatten(Density::box(Vec3(0.0), Vec3(1.0)), 0.8));
    REQUIRE(density.at(Vec3(0.5)) > 0.5);
    for (const double half : {0.05, 0.1, 0.2, 0.3}) {
        const Vec3 off(0.01, -0.02, 0.015);  // keeps the cube's middle off the cell's corners and center
        CHECK_FALSE(is_simple(density, corners_of({Vec3(0.5 - half) + off, Vec3(0.5 + half) + off}), 1e-9));
    }
    CHECK(is_simple(density, corners_of({Vec3(0.6), Vec3(0.9)}), 1e-9));
}

TEST_CASE("A part of the surface that lies whole in one undecided cell is in the mesh") {
    const Solid lost =
        Solid::rounded(0.75, Density::box({0, 0, 0}, {4, 3, 4}) | Density::box({6, 0, 1.5}, {7, 1, 2.5}));
    for (const double tolerance : {infinity, 0.05}) {
        const SolidTree tree = flatten(lost);
        const Mesh mesh = triage(tree, polygonization_box(tree), {tolerance});
        CHECK(topology(mesh).shells == 2);
        CHECK(topology(mesh).manifold());
    }
    for (const double r : {0.7, 0.8, 0.82}) {
        CAPTURE(r);
        const SolidTree tree = flatten(Solid::rounded(r, Density::box(Vec3(0.0), Vec3(1.0))));
        const Mesh mesh = triage(tree, polygonization_box(tree));
        CHECK(topology(mesh).shells == 1);
        CHECK(volume(mesh) > 0);
    }
}
