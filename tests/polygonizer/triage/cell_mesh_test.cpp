// The cells of a triage subdivision as closed meshes, with the classes of their densities.
#include "polygonizer/triage/cell_mesh.hpp"

#include "catch.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

TEST_CASE("The cells of a subdivision are closed meshes that fill its box, and have the class of what is in them") {
    const SolidTree tree = flatten(Solid::rounded(
        0.1, Density::box(Vec3(0.0), Vec3(1.0)) -
                 Density::half_space({0, 1, 0}, 1) * Density::box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75})));
    const DensityTree& density = tree.leaves[0].density;
    const Box box{Vec3(-0.2), Vec3(1.2)};
    const Subdivision subdivision(tree, box);
    double filled = 0;
    std::size_t unclassified = 0;
    for (int cell = 0; cell < int(subdivision.complex.cells.size()); ++cell) {
        const Mesh mesh = cell_mesh(subdivision.complex, cell);
        CHECK(topology(mesh).manifold());
        CHECK(volume(mesh) > 0);
        CHECK(volume(cell_mesh(subdivision.complex, cell, 0.5, Vec3(3, 0, 0))) == Approx(volume(mesh) / 8));
        filled += volume(mesh);
        const DensityClass c = cell_class(subdivision, cell, 0, density);
        const ClassInterval interval = interval_of(c);
        unclassified += c == DensityClass::unclassified;
        // Points between the cell's middle and its corners have densities in the interval of the cell's class.
        const Vec3 middle = cell_middle(subdivision.complex, cell);
        for (const Vec3& corner : mesh.positions)
            for (const double t : {0.0, 0.3, 0.8}) {
                const double rho = density.at(glm::mix(middle, corner, t));
                CHECK(rho >= interval.lo - 1e-9);
                CHECK(rho <= interval.hi + 1e-9);
            }
    }
    CHECK(filled == Approx(1.4 * 1.4 * 1.4));
    CHECK(unclassified > 20);
}
