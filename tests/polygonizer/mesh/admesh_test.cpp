// STL files of random parts, checked by admesh.
#include "polygonizer/admesh.hpp"

#include "catch.hpp"
#include "polygonizer/mesh/export.hpp"
#include "polygonizer/random_part.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/folder.hpp"

using namespace deburr;

TEST_CASE("admesh finds nothing to repair in the STL of random parts") {
    if (!has_admesh()) {
        WARN("admesh is not installed");
        return;
    }
    const test::Folder folder;
    for (int seed = 1; seed <= 12; ++seed) {
        CAPTURE(seed);
        RandomPart random(seed);
        const SolidTree part = flatten(random.solid());
        const double tolerance = random.radius() > 0 ? 0.05 * random.radius() : infinity;
        const Mesh mesh = triage(part, polygonization_box(part), {.tolerance = tolerance});
        test::write_file(folder / "a.stl", encode(mesh, MeshFormat::stl));
        CHECK(admesh_repairs(folder / "a.stl", folder / "log") == "");
    }
}

TEST_CASE("admesh_repairs tells what is wrong") {
    if (!has_admesh()) return;
    const test::Folder folder;
    const SolidTree cube = flatten(Solid::sharp(Density::box(Vec3(0.0), Vec3(1.0))));
    Mesh mesh = triage(cube, polygonization_box(cube));
    mesh.triangles.pop_back();
    test::write_file(folder / "a.stl", encode(mesh, MeshFormat::stl));
    CHECK(admesh_repairs(folder / "a.stl", folder / "log").find("Facets added") != std::string::npos);
}
