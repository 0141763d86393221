// The bounding box of an intersection of half-spaces: the shortcut for axis-parallel planes against linear programming.
#include "bounds/polyhedron_box.hpp"

#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

TEST_CASE("planes along the axes give the box that the linear programs give") {
    int bounded = 0, empty = 0;
    for (const auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        std::vector<BoundPlane> planes;
        for (int k = 0; k < 3; ++k)
            for (const double sign : {1.0, -1.0}) {
                Vec3 normal(0);
                normal[k] = sign;
                planes.push_back({normal, 10});
            }
        for (int i = 0, count = 1 + g.below(9); i < count; ++i) {
            Vec3 normal(0);
            normal[g.below(3)] = g.chance(0.5) ? 1 : -1;
            planes.push_back({normal, g.between(-1, 3)});
        }
        const Box box = polyhedron_box(planes);
        // This plane excludes nothing, but as it is not axis-parallel the linear programs are solved.
        planes.push_back({glm::normalize(Vec3(1, 1, 1)), 100});
        const Box want = polyhedron_box(planes);
        REQUIRE(box.empty() == want.empty());
        empty += box.empty();
        if (box.empty()) continue;
        for (int k = 0; k < 3; ++k)
            for (const auto& [got, expected] : {std::pair{box.lo[k], want.lo[k]}, {box.hi[k], want.hi[k]}}) {
                ++bounded;
                CHECK(std::abs(got - expected) <= 2e-7);  // either road adds 10⁻⁹ of the largest offset
            }
    }
    CHECK(bounded > 1'000);
    CHECK(empty > 100);
}
