// A mesh in blocks that threads may change side by side.
//
// Blocks depend on the mesh alone, and so does what becomes of them: neither on the number of threads nor on their
// order. What lies where blocks meet is left to whoever has them together again.
#pragma once
#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// Triangles of a mesh as a mesh of their own, open where they end.
struct MeshBlock {
    Mesh mesh;
    std::vector<Origin> origins;
    // Of the block's vertices and normals: what number each has in the whole mesh, or −1 for what was put in since.
    std::vector<int> vertices, normals;
    std::vector<char> on_border;  // of the block's vertices: whether other blocks have it, too
};

/// Blocks of no more than `most` triangles each: halves by their middles across the longest side, again and again.
std::vector<MeshBlock> cut_into_blocks(const Mesh& mesh, const std::vector<Origin>& origins, std::size_t most);

/// Puts blocks together again whose borders are as they were. `mesh` is the one that they were cut from; what it no
/// longer uses stays in it until Facets::finish() drops it. Returns which vertices are on a border.
std::vector<char> join_blocks(const std::vector<MeshBlock>& blocks, Mesh& mesh, std::vector<Origin>& origins);

}  // namespace deburr
