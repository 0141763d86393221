#include "bounds/box_range.hpp"

#include "bounds/local_density.hpp"
#include "bounds/solid_range.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

Box random_box(Gen& g, Vec3 at) {
    const Vec3 half = g.chance(0.2) ? Vec3(0.5) : Vec3(g.between(0.01, 0.4));
    Box box{at - half, at + half};
    if (g.chance(0.1)) box.hi[g.below(3)] = infinity;
    if (g.chance(0.1)) box.lo[g.below(3)] = -infinity;
    return box;
}

// Corners and faces as often as the inside.
Vec3 point_in(const Box& box, Gen& g) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) {
        const double lo = std::max(box.lo[k], -9.0), hi = std::min(box.hi[k], 9.0);
        x[k] = g.chance(0.3) ? lo : g.chance(0.5) ? hi : g.between(lo, hi);
    }
    return x;
}

DensityTree random_tree(Gen& g) {
    return flatten(g.chance(0.5) ? g.boolean(2) : g.arithmetic(2), g.radius(), g.chance(0.3) ? g.map() : Affine{});
}

}  // namespace

TEST_CASE("a density lies in its range over the box, and what is pruned to the box equals it there") {
    int pruned_away = 0, decided = 0, inner = 0;
    for (auto seed : seeds(8'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = random_tree(g);
        const Box box = random_box(g, g.near(tree));
        const Pruned local = prune(tree, box);
        const LocalDensity fast(local.tree);
        const Range tighter = fast.range(box);
        const LocalSize size = local_size(tree, box);
        REQUIRE(std::size_t(size.half_spaces) == local.tree.half_spaces.size());
        pruned_away += local.tree.half_spaces.size() < tree.half_spaces.size();
        decided += classify(local.range) != Side::straddling;
        for (int k = 0; k < 4; ++k) {
            const Vec3 x = point_in(box, g);
            const double rho = plain::density(tree, x);
            REQUIRE(rho >= local.range.lo - 1e-12);
            REQUIRE(rho <= local.range.hi + 1e-12);
            REQUIRE(rho >= tighter.lo - 1e-12);
            REQUIRE(rho <= tighter.hi + 1e-12);
            REQUIRE(std::abs(plain::density(local.tree, x) - rho) < 1e-12);
            REQUIRE(std::abs(fast.at(x) - rho) < 1e-12);
            inner += rho > 0 && rho < 1;
        }
    }
    CHECK(pruned_away > 5'000);
    CHECK(decided > 1'000);
    CHECK(inner > 3'000);
}

TEST_CASE("a solid pruned to a box has the same inside there") {
    int straddling = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const SolidTree tree = flatten(g.solid(2));
        const Box box = random_box(g, g.near(tree.leaves[0].density));
        const SolidTree local = prune(tree, box);
        const LocalSolidSize size = local_size(tree, box);
        straddling += size.side == Side::straddling;
        for (int k = 0; k < 4; ++k) {
            const Vec3 x = point_in(box, g);
            const bool inside = plain::contains(tree, x);
            REQUIRE(plain::contains(local, x) == inside);
            if (size.side != Side::straddling) REQUIRE(inside == (size.side == Side::inside));
        }
    }
    CHECK(straddling > 800);
}

TEST_CASE("a holed cube leaves two half-spaces in boxes of half the radius, as docs/design.md says") {
    const double r = 0.05;
    const DensityTree tree = flatten(Density::box(Vec3(0), Vec3(1)) & ~Density::box({0.3, -1, 0.3}, {0.7, 2, 0.7}), r);
    REQUIRE(tree.half_spaces.size() == 12);
    double left = 0;
    int boxes = 0;
    const int n = int(1.2 / (r / 2));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                const Vec3 lo = Vec3(-0.1) + Vec3(i, j, k) * (r / 2);
                const LocalSize size = local_size(tree, {lo, lo + Vec3(r / 2)});
                if (classify(size.range) != Side::straddling) continue;
                left += size.half_spaces;
                ++boxes;
            }
    CHECK(boxes > 5'000);
    CHECK(left / boxes < 2.0);
}
