// Meshes cut into blocks and joined again, and decimation in blocks.
#include "polygonizer/mesh/mesh_blocks.hpp"

#include <algorithm>

#include "catch.hpp"
#include "polygonizer/mesh/decimate.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/surface.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

// The undecimated mesh of a plate with a grid of square holes.
struct Dense {
    SolidTree tree;
    Mesh mesh;
    std::vector<Origin> origins;
};

Dense dense_plate(int holes) {
    Density all = Density::box({0, 0, 0}, {double(holes), 0.3, double(holes)});
    for (int i = 0; i < holes; ++i)
        for (int k = 0; k < holes; ++k) all = all & ~Density::box({i + 0.3, -1, k + 0.2}, {i + 0.7, 1, k + 0.8});
    Dense dense{flatten(Solid::rounded(0.05, all)), {}, {}};
    Subdivision subdivision(dense.tree, polygonization_box(dense.tree));
    Subspace subspace(subdivision);
    subspace.polygonize();
    dense.mesh = surface(subspace, dense.tree, &dense.origins);
    return dense;
}

// Corner positions of all triangles, sorted, so that they do not depend on the triangles' order.
std::vector<std::array<double, 9>> corners(const Mesh& mesh) {
    std::vector<std::array<double, 9>> all;
    for (const Triangle& t : mesh.triangles) {
        std::array<double, 9> one;
        for (std::size_t k = 0; k < 9; ++k) one[k] = mesh.positions[t.vertex[k / 3]][int(k % 3)];
        all.push_back(one);
    }
    std::sort(all.begin(), all.end());
    return all;
}

}  // namespace

TEST_CASE("Blocks of a mesh are all of it, and together again they are the mesh") {
    const Dense dense = dense_plate(3);
    const std::size_t most = 300;
    const std::vector<MeshBlock> blocks = cut_into_blocks(dense.mesh, dense.origins, most);
    CHECK(blocks.size() > 4);
    std::vector<int> times(dense.mesh.positions.size(), 0);
    std::size_t triangles = 0;
    for (const MeshBlock& block : blocks) {
        CHECK(block.mesh.triangles.size() <= most);
        CHECK(block.origins.size() == block.mesh.triangles.size());
        triangles += block.mesh.triangles.size();
        for (const int v : block.vertices) ++times[v];
    }
    CHECK(triangles == dense.mesh.triangles.size());
    int shared = 0;
    for (const MeshBlock& block : blocks)
        for (std::size_t k = 0; k < block.vertices.size(); ++k) {
            CHECK(bool(block.on_border[k]) == (times[block.vertices[k]] > 1));
            shared += block.on_border[k];
        }
    CHECK(shared > 100);

    Mesh joined = dense.mesh;
    std::vector<Origin> origins = dense.origins;
    const std::vector<char> border = join_blocks(blocks, joined, origins);
    CHECK(corners(joined) == corners(dense.mesh));
    CHECK(origins.size() == joined.triangles.size());
    CHECK(topology(joined).manifold());
    for (std::size_t v = 0; v < border.size(); ++v) CHECK(bool(border[v]) == (times[v] > 1));
}

TEST_CASE("A mesh that is thinned out in blocks has little more left than one that is thinned out whole") {
    Dense dense = dense_plate(9);
    const std::size_t before = dense.mesh.triangles.size();
    REQUIRE(before > 20'000);
    const FacetJudge judge(dense.tree, dense.mesh);
    const double tolerance = 0.01;
    Mesh whole = dense.mesh;
    std::vector<Origin> origins = dense.origins;
    // With `enough` = 1 decimate() works on the whole mesh and not in blocks.
    decimate(whole, origins, judge, tolerance, {.enough = 1});
    decimate(dense.mesh, dense.origins, judge, tolerance);
    CHECK(double(dense.mesh.triangles.size()) < 1.05 * double(whole.triangles.size()));
    CHECK(2 * whole.triangles.size() < before);
    const MeshMetrics m = measure(dense.mesh, dense.tree);
    CHECK(m.topology.manifold());
    CHECK(m.inverted == 0);
    CHECK(m.vertex_distance < 1e-9);
}
