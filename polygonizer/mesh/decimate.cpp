#include "polygonizer/mesh/decimate.hpp"

#include <numeric>

#include "bounds/in_parallel.hpp"
#include "polygonizer/mesh/edge_collapses.hpp"
#include "polygonizer/mesh/mesh_blocks.hpp"

namespace deburr {
namespace {

// Triangles of a block: too much of a smaller one would be border.
constexpr std::size_t most_of_block = 10'000;
constexpr double share_of_blocks = 0.85;  // fraction of the work that blocks take, without the places where they meet

// The entries of `known` for elements that were kept, whose old numbers are `numbers`; `since` for elements added
// since.
template <class T>
std::vector<T> kept(const std::vector<int>& numbers, const std::vector<T>& known, T since) {
    std::vector<T> of;
    of.reserve(numbers.size());
    for (const int n : numbers) of.push_back(std::size_t(n) < known.size() ? known[n] : since);
    return of;
}

// Decimates one block and returns the number of vertices removed.
std::size_t decimate_block(MeshBlock& block, const FacetJudge& judge, double tolerance, std::span<const Box> dense,
                           CancelFlag cancel) {
    std::vector<int> vertices, normals;
    const std::size_t gone =
        collapse_edges(block.mesh, block.origins, judge, tolerance,
                       {.dense = dense, .border = block.on_border, .cancel = cancel}, &vertices, &normals);
    block.vertices = kept(vertices, block.vertices, -1);
    block.normals = kept(normals, block.normals, -1);
    block.on_border = kept(vertices, block.on_border, char(false));
    return gone;
}

// Decimates the blocks of a large mesh concurrently and returns the number of vertices removed. `border` becomes the
// vertices where blocks meet.
std::size_t decimate_blocks(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                            const DecimationOptions& options, std::vector<char>& border) {
    std::vector<MeshBlock> blocks = cut_into_blocks(mesh, origins, most_of_block);
    std::vector<std::size_t> gone(blocks.size(), 0);
    in_parallel(blocks.size(), [&](std::size_t k) {
        judge.lend([&](const FacetJudge& own) {
            gone[k] = decimate_block(blocks[k], own, tolerance, options.dense, options.cancel);
        });
        if (options.progress) options.progress->advance(share_of_blocks / double(blocks.size()));
    });
    border = join_blocks(blocks, mesh, origins);
    return std::accumulate(gone.begin(), gone.end(), std::size_t(0));
}

}  // namespace

std::size_t decimate(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                     const DecimationOptions& options) {
    if (mesh.triangles.empty()) return 0;
    std::size_t gone = 0;
    std::vector<char> border;
    const bool in_blocks = options.enough == 0 && mesh.triangles.size() > 2 * most_of_block;
    if (in_blocks) gone = decimate_blocks(mesh, origins, judge, tolerance, options, border);
    return gone + collapse_edges(mesh, origins, judge, tolerance,
                                 {.dense = options.dense,
                                  .around = border,
                                  .enough = options.enough,
                                  .cancel = options.cancel,
                                  .progress = options.progress,
                                  .share_of_phase = in_blocks ? 1 - share_of_blocks : 1});
}

}  // namespace deburr
