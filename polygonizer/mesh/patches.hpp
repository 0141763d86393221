// Patches of a mesh that were changed by themselves, so that what became of them can be put in again where the same
// mesh comes anew but for a few places.
//
// A flip, a split, a collapse, or a vertex that moves, makes one patch of all facets that it changes. So a patch has
// the same border before and after: what became of its facets fits wherever the same facets come again.
#pragma once
#include <span>
#include <vector>

#include "bounds/union_find.hpp"
#include "polygonizer/mesh/good_facets.hpp"

namespace deburr {

class Patches {
public:
    Patches() = default;
    /// Each triangle of the mesh, whose edges are each in two triangles, is a patch of its own.
    Patches(const Mesh& mesh, const std::vector<Origin>& origins);

    /// The mesh is as it was given, but for `change`, whose facets that came have the numbers `fresh`.
    void change(const Change& change, const std::vector<int>& fresh);
    /// What these facets have in common changed.
    void join(std::span<const int> facets);
    /// The mesh is numbered anew: `facets`, `vertices` and `normals` are the numbers that what is left of it had.
    void renumber(const std::vector<int>& facets, const std::vector<int>& vertices, const std::vector<int>& normals);

    /// Puts what became of the patches, which is `mesh`, in the place of the same facets of `fresh`: patches all of
    /// whose facets are there, by the bits of their corners and by their origins, and that hold none of the triangles
    /// `but`. The patches of `fresh`, as it is then; vertices that no facet has any more may be left in it.
    Patches put_into(Mesh& fresh, std::vector<Origin>& fresh_origins, const Mesh& mesh,
                     const std::vector<Origin>& origins, std::span<const int> but) const;

private:
    class Insertion;

    // Of a facet at first.
    struct Source {
        FacetKey key;
        std::array<int, 3> vertex, normal;
    };

    std::vector<Source> sources_;
    UnionFind joined_;                     // of sources
    std::vector<int> source_;              // of each facet as it is now: one of its patch's
    std::vector<int> vertices_, normals_;  // of those that there are now: the numbers at first; −1: put in since
};

}  // namespace deburr
