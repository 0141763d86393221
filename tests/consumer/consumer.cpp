// A program that links the installed libraries: it rounds a cube, evaluates its density and encodes its mesh as STL.
#include <cstdio>

#include "polygonizer/mesh/export.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/triage.hpp"

int main() {
    using namespace deburr;
    const Density cube = Density::box(Vec3(0), Vec3(1));
    const SolidTree tree = flatten(Solid::rounded(0.1, cube));
    const double corner = flatten(cube, 0.1).at(Vec3(1));
    const Mesh mesh = triage(tree, polygonization_box(tree));
    const MeshMetrics found = measure(mesh, tree);
    std::printf("density at the corner %g, %zu triangles, volume %g, %zu bytes of STL\n", corner, mesh.triangles.size(),
                found.volume, encode(mesh, MeshFormat::stl).size());
    // At the corner three half-spaces meet, so ρ is ⅛; the volume is a little less than the sharp cube's.
    return corner == 0.125 && found.topology.closed() && found.volume > 0.95 && found.volume < 1 ? 0 : 1;
}
