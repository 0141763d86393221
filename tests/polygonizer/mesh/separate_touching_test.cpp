// Parts that touch stay separate for readers that join vertices by position, and facets that are too small are merged.
#include "polygonizer/mesh/separate_touching.hpp"

#include <algorithm>

#include "catch.hpp"
#include "polygonizer/random_solid.hpp"
#include "polygonizer/triage/triage.hpp"
#include "polygonizer/unit_cube.hpp"
#include "polygonizer/welded.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

Mesh touching_mesh(const Solid& solid) {
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
                Mesh mesh = touching_mesh(Solid::rounded(r, unit_cube() + unit_cube(at)).transformed(map));
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
    Mesh mesh = touching_mesh(Solid::sharp(unit_cube()));
    mesh.append(touching_mesh(Solid::sharp(unit_cube(Vec3(1, 0, 0)))), 1);
    CHECK_FALSE(topology(welded(mesh)).manifold());
    CHECK(separate_touching(mesh) == 0);
    CHECK(topology(welded(mesh)).manifold());
    CHECK(topology(welded(mesh)).shells == 2);
    CHECK(std::abs(volume(mesh) - 2) < 1e-5);
}

TEST_CASE("A mesh without touching parts is left as it is") {
    Mesh mesh = touching_mesh(Solid::rounded(0.1, unit_cube()));
    const Mesh before = mesh;
    CHECK(separate_touching(mesh) == 0);
    CHECK(mesh.positions == before.positions);
}

TEST_CASE("Facets of a few steps of single precision are no facets") {
    Mesh mesh = touching_mesh(Solid::sharp(Density::box(Vec3(1.0), Vec3(2.0))));
    REQUIRE(merge_close(mesh) == 0);
    const Mesh before = mesh;
    // An edge of the cube is cut near its end, at 5·10⁻⁷ of its length.
    const int a = mesh.triangles[0].vertex[0], b = mesh.triangles[0].vertex[1], middle = int(mesh.positions.size());
    mesh.positions.push_back(glm::mix(mesh.positions[a], mesh.positions[b], 5e-7));
    for (std::size_t i = 0; i < before.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3;
            Triangle& t = mesh.triangles[i];
            if (std::minmax(t.vertex[k], t.vertex[l]) != std::minmax(a, b)) continue;
            Triangle rest = t;
            t.vertex[l] = rest.vertex[k] = middle;
            mesh.triangles.push_back(rest);
            break;
        }
    REQUIRE(mesh.triangles.size() == before.triangles.size() + 2);
    REQUIRE(topology(mesh).manifold());
    CHECK(merge_close(mesh) == 1);
    CHECK(topology(mesh).manifold());
    CHECK(mesh.triangles.size() == before.triangles.size());
    CHECK(volume(mesh) == Approx(1));
}
