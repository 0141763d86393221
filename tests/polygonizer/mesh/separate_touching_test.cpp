#include "polygonizer/mesh/separate_touching.hpp"

#include "catch.hpp"
#include "polygonizer/random_solid.hpp"
#include "polygonizer/triage/triage.hpp"
#include "polygonizer/welded.hpp"

using namespace deburr;

namespace {

Density unit_cube_at(Vec3 at) { return Density::box(at, at + Vec3(1.0)); }

Mesh mesh_of(const Solid& solid) {
    const SolidTree tree = flatten(solid);
    return triage(tree, polygonization_box(tree));
}

}  // namespace

TEST_CASE("Parts that touch stay apart for a reader that joins vertices by position") {
    for (const Vec3 at : {Vec3(1, 1, 0), Vec3(1, 1, 1)})
        for (const double scale : {1.0, 1e-3, 1e3})
            for (const double r : {0.0, 0.1}) {
                CAPTURE(at.z, scale, r);
                Affine map;
                map.linear = Mat3(scale);
                Mesh mesh = mesh_of(Solid::rounded(r, unit_cube_at(Vec3(0.0)) + unit_cube_at(at)).transformed(map));
                const Mesh before = mesh;
                if (r == 0) CHECK_FALSE(topology(welded(mesh)).manifold());
                CHECK(separate_touching(mesh, single_precision_step(mesh)) == 0);
                const Topology t = topology(welded(mesh));
                CHECK(t.manifold());
                CHECK(t.shells == 2);
                double moved = 0;
                for (std::size_t v = 0; v < mesh.positions.size(); ++v)
                    moved = std::max(moved, glm::length(mesh.positions[v] - before.positions[v]));
                CHECK(moved <= std::max(1e-6, 1e-6 * scale));
            }
}

TEST_CASE("Solids that share a face stay two shells") {
    Mesh mesh = mesh_of(Solid::sharp(unit_cube_at(Vec3(0.0))));
    mesh.append(mesh_of(Solid::sharp(unit_cube_at(Vec3(1, 0, 0)))), 1);
    CHECK_FALSE(topology(welded(mesh)).manifold());
    CHECK(separate_touching(mesh) == 0);
    CHECK(topology(welded(mesh)).manifold());
    CHECK(topology(welded(mesh)).shells == 2);
    CHECK(std::abs(volume(mesh) - 2) < 1e-5);
}

TEST_CASE("A mesh without touching parts is left as it is") {
    Mesh mesh = mesh_of(Solid::rounded(0.1, unit_cube_at(Vec3(0.0))));
    const Mesh before = mesh;
    CHECK(separate_touching(mesh) == 0);
    CHECK(mesh.positions == before.positions);
}
