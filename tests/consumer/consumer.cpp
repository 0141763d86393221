// Rounds a cube, asks for its density at a corner, and writes its mesh as STL: what the libraries are for.
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
    // An eighth, for three half-spaces meet there; and a little less than the sharp cube.
    return corner == 0.125 && found.topology.closed() && found.volume > 0.95 && found.volume < 1 ? 0 : 1;
}
