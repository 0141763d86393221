// Sharp densities as Boolean functions: sharp_set() against the values of the densities.
#include "polygonizer/mesh/sharp_set.hpp"

#include "catch.hpp"
#include "polygonizer/random_solid.hpp"

using namespace deburr;

TEST_CASE("A sharp density is the set that its Boolean function says, also where sums and differences are illegal") {
    int sharp = 0, illegal = 0, inside = 0;
    for (int seed = 0; seed < 400; ++seed) {
        CAPTURE(seed);
        for (const SolidLeaf& leaf : flatten(RandomSolid(seed).solid()).leaves) {
            DensityTree density = leaf.density;
            for (HalfSpace& h : density.half_spaces) h.radius = 0;
            const DensityTree set = sharp_set(density);
            ++sharp;
            for (const TreeNode& n : set.nodes)
                CHECK((n.op != Op::sum && n.op != Op::product && n.op != Op::difference));
            std::mt19937_64 random(std::uint64_t(seed) + 1);
            for (int k = 0; k < 200; ++k) {
                Vec3 x;
                for (int axis = 0; axis < 3; ++axis) x[axis] = double(random() >> 11) * 0x1p-53 * 2.5 - 0.25;
                const double rho = density.at(x);
                illegal += rho < 0 || rho > 1;
                inside += rho > 0.5;
                CHECK((rho > 0.5) == (set.at(x) > 0.5));
            }
        }
    }
    CHECK(sharp > 300);
    CHECK(illegal > 100);
    CHECK(inside > 1000);
}

TEST_CASE("Legal sums and differences of sharp densities are unions and differences, of a little more nodes") {
    std::vector<Density> boxes;
    for (int k = 0; k < 50; ++k) boxes.push_back(Density::box(Vec3(2.0 * k, 0, 0), Vec3(2.0 * k + 1, 1, 1)));
    Density sum = boxes[0];
    for (int k = 1; k < 50; ++k) sum = sum + boxes[k];
    const DensityTree tree = flatten(sum - Density::box(Vec3(0.25), Vec3(0.75)), 0);
    CHECK(sharp_set(tree).nodes.size() < 1.25 * double(tree.nodes.size()));
}
