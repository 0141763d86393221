// A mesh cut into blocks that threads may change concurrently.
//
// Blocks depend on the mesh alone, so the result depends neither on the number of threads nor on their order. Where
// blocks meet nothing may change until they are joined again.
#pragma once
#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// A part of a mesh's triangles as a mesh of its own, open at its border.
struct MeshBlock {
    Mesh mesh;
    std::vector<Origin> origins;
    // For each vertex and normal of the block its index in the whole mesh, or −1 if it was added since.
    std::vector<int> vertices, normals;
    std::vector<char> on_border;  // for each vertex of the block, whether other blocks share it
};

/// Cuts the mesh into blocks of at most `most` triangles, by halving at the median across the longest side,
/// recursively.
std::vector<MeshBlock> cut_into_blocks(const Mesh& mesh, const std::vector<Origin>& origins, std::size_t most);

/// Joins blocks whose borders are unchanged. `mesh` is the mesh that they were cut from, and becomes the joined one;
/// vertices that it no longer uses stay in it until Facets::finish() drops them. Returns for each vertex whether it is
/// on a border.
std::vector<char> join_blocks(const std::vector<MeshBlock>& blocks, Mesh& mesh, std::vector<Origin>& origins);

}  // namespace deburr
