// Ranges of a density over boxes, and trees pruned to boxes, against the plain definition.
#include "bounds/box_range.hpp"

#include <ctime>
#include <vector>

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

// A random point of the box, mostly on its sides, edges and corners; infinite sides are cut at ±9.
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

TEST_CASE("looks into several boxes at once see what looks into one after the other see") {
    int left = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = random_tree(g);
        const SolidTree solid = flatten(g.solid(2));
        std::vector<Box> boxes;
        for (int k = g.below(8); k >= 0; --k)
            boxes.push_back(g.chance(0.1) ? Box::everything() : random_box(g, g.near(tree)));
        std::vector<LocalSize> sizes(boxes.size());
        local_sizes(tree, boxes, sizes.data());
        std::vector<LocalSolidSize> solid_sizes(boxes.size());
        local_sizes(solid, boxes, solid_sizes.data());
        for (std::size_t k = 0; k < boxes.size(); ++k) {
            const Pruned local = prune(tree, boxes[k]);
            REQUIRE(sizes[k].half_spaces == int(local.tree.half_spaces.size()));
            REQUIRE(sizes[k].range.lo == local.range.lo);
            REQUIRE(sizes[k].range.hi == local.range.hi);
            left += sizes[k].half_spaces > 1;
            const LocalSolidSize one = local_size(solid, boxes[k]);
            REQUIRE(solid_sizes[k].side == one.side);
            REQUIRE(solid_sizes[k].leaves == one.leaves);
            REQUIRE(solid_sizes[k].half_spaces == one.half_spaces);
        }
    }
    CHECK(left > 2'000);
}

TEST_CASE("whether operands keep to [0, 1] is asked of each part's range, in one walk over the tree") {
    int held = 0, broken = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = random_tree(g);
        const Box box = g.chance(0.2) ? Box::everything() : random_box(g, g.near(tree));
        bool all = true;
        for (const TreeNode& n : tree.nodes) {
            if (n.op == Op::half_space || n.op == Op::constant) continue;
            for (const int operand : {n.a, n.b}) {
                if (operand < 0) continue;
                DensityTree part = tree;
                part.nodes.resize(std::size_t(operand) + 1);
                const Op op = part.nodes.back().op;
                const Range rho = density_range(part, box);
                if (op == Op::sum || op == Op::difference) all &= rho.lo >= 0 && rho.hi <= 1;
            }
        }
        REQUIRE(bounds_hold(tree, box) == all);
        (all ? held : broken)++;
    }
    CHECK(held > 500);
    CHECK(broken > 300);

    Density chain = Density::box(Vec3(0), Vec3(1));
    for (int k = 1; k <= 10'000; ++k) chain = chain - Density::box(Vec3(0.3 + 1e-5 * k), Vec3(0.5 + 1e-5 * k));
    const DensityTree tree = flatten(chain, 0.1);
    const std::clock_t begin = std::clock();
    CHECK_FALSE(bounds_hold(tree, Box::everything()));
    CHECK(double(std::clock() - begin) / CLOCKS_PER_SEC < 0.5);  // 2 ms; a walk for each operand takes 10 s
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
