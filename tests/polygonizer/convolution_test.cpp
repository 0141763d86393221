// Meshes of true convolutions [Triage §8].
#include "bounds/local_density.hpp"
#include "catch.hpp"
#include "polygonizer/marching_cubes/marching_cubes.hpp"
#include "polygonizer/triage/triage.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

// Greatest |ρ − ½| at the mesh's vertices.
double off_surface(const Mesh& mesh, const SolidTree& tree) {
    double worst = 0;
    for (const Vec3& x : mesh.positions) worst = std::max(worst, std::abs(tree.leaves[0].density.at(x) - 0.5));
    return worst;
}

}  // namespace

TEST_CASE("triage and marching cubes make closed manifolds of convolved solids, with their vertices on the surface",
          "[slow]") {
    int shells = 0;
    for (auto seed : seeds(60)) {
        CAPTURE(seed);
        Gen g(seed);
        Density d = g.box();
        for (int k = g.below(3); k > 0; --k) d = g.chance(0.5) ? d | g.box() : d & ~g.box();
        if (d.has_radius()) continue;
        const double r = g.between(0.08, 0.3);
        const SolidTree tree = flatten(Solid::convolved(r, d));
        const Box box = polygonization_box(tree);
        if (box.empty()) continue;
        const Mesh by_triage = triage(tree, box), by_cubes = marching_cubes(tree, box, 0.6 * r);
        CHECK(topology(by_triage).manifold());
        CHECK(topology(by_cubes).manifold());
        CHECK(off_surface(by_triage, tree) < 1e-6);
        CHECK(off_surface(by_cubes, tree) < 1e-2);  // marching cubes pulls touching vertices apart a little
        shells += int(topology(by_triage).shells);
        CHECK(volume(by_triage) == Approx(volume(by_cubes)).epsilon(0.05).margin(0.02));
    }
    CHECK(shells > 40);
}

TEST_CASE("a convolved cube has the faces of a rounded one, and its edges and corners nearly") {
    const Density cube = Density::box(Vec3(0), Vec3(1));
    const SolidTree exact = flatten(Solid::convolved(0.1, cube)), quasi = flatten(Solid::rounded(0.1, cube));
    const Box box = polygonization_box(exact);
    const Mesh a = triage(exact, box), b = triage(quasi, box);
    CHECK(a.polygons == b.polygons);
    CHECK(std::abs(volume(a) - volume(b)) < 1e-3);
    CHECK(volume(a) != volume(b));
}
