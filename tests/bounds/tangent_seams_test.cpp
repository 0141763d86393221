// Where round parts run on smoothly into other surfaces.
#include "bounds/tangent_seams.hpp"

#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

std::vector<TangentSeam> seams(const Density& d, double r = 0.1) { return tangent_seams(flatten(d, r)); }

Density rod(Vec3 from, Vec3 to, double R) { return Density::cylinder(from, to, R); }

}  // namespace

TEST_CASE("surfaces that run on smoothly are found, with how much they bulge") {
    const double r = 0.1;
    const Density half_disc = rod({2, 0, -1}, {2, 0, 1}, 0.5), box = Density::box({0, -0.5, -1}, {2, 0.5, 1});
    struct Case {
        const char* name;
        Density density;
    };
    const Case all[] = {
        {"a box that runs into a half-cylinder", box | half_disc},
        {"a rod with a ball at its end", rod({0, 0, 0}, {0, 2, 0}, 0.5) | Density::sphere({0, 2, 0}, 0.5)},
        {"a ball in the tip of a cone",
         Density::cone({0, 0, 0}, {0, 2, 0}, 1, 0) | Density::sphere({0, 0.6, 0}, 1.4 / std::sqrt(5.0))},
        {"a plane along a ring", Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.4) | rod({0, -0.4, 0}, {0, 0.4, 0}, 1)},
        {"a ball in a larger one", Density::sphere(Vec3(0.0), 1) | Density::sphere({0.4, 0, 0}, 0.6)},
        {"a rod along the inside of another", rod({0, -1, 0}, {0, 1, 0}, 1) | rod({0.4, -1, 0}, {0.4, 1, 0}, 0.6)},
    };
    for (const Case& c : all) {
        CAPTURE(c.name);
        const DensityTree tree = flatten(c.density, r);
        const std::vector<TangentSeam> found = tangent_seams(tree);
        REQUIRE(!found.empty());
        for (const TangentSeam& seam : found) {
            CHECK(seam.radius == r);
            CHECK(seam.bulge > 0.02 * r);
            CHECK(seam.bulge < 0.36 * r);
        }
    }
    // Two equal half-spaces in a union: ρ = ½ where F = 1 − √½.
    const double expected = displacement(1 - std::sqrt(0.5));
    const auto two = seams(Density::sphere(Vec3(0.0), 1) | Density::sphere({0.4, 0, 0}, 0.6));
    REQUIRE(two.size() == 1);
    CHECK(largest(two[0].at - Vec3(1, 0, 0)) < 1e-9);
    CHECK(two[0].bulge == Approx(r * expected).epsilon(0.02));
}

TEST_CASE("where surfaces meet in edges, share a draw or touch from outside there is no seam") {
    const Density cube = Density::box(Vec3(-1.0), Vec3(1.0));
    CHECK(seams(cube | rod({0, 0, 0}, {0, 3, 0}, 0.5)).empty());
    CHECK(seams(cube & ~rod({0, -3, 0}, {0, 3, 0}, 0.5)).empty());
    CHECK(seams(cube | Density::sphere({0, 1, 0}, 0.5)).empty());
    CHECK(seams(rod({0, 0, 0}, {0, 2, 0}, 1) | rod({0, 1, 0}, {0, 3, 0}, 1)).empty());  // flush: one family
    CHECK(seams(Density::sphere({0, 2, 0}, 1) | cube).empty());                         // touches from outside
    CHECK(seams(Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.3)).empty());
    // Where they would touch, one of them bounds nothing.
    CHECK(seams((cube | rod({0, 0.5, -0.5}, {0, 0.5, 0.5}, 0.5)) & Density::half_space({0, 1, 0}, 0.5)).empty());
    CHECK(seams(cube).empty());
}
