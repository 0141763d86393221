// Patches of a mesh that changed independently of the rest, so that the changes can be reused when the same mesh is
// made again except for a few places.
//
// A flip, a split, a collapse, or moving a vertex joins all facets that it changes into one patch. So a patch has the
// same border before and after, and its changed facets fit wherever the same original facets come again.
#pragma once
#include <span>
#include <vector>

#include "bounds/union_find.hpp"
#include "polygonizer/mesh/good_facets.hpp"

namespace deburr {

/// The patches of a mesh, which follow its changes. "Sources" are the mesh's facets at the start.
class Patches {
public:
    Patches() = default;
    /// Makes every triangle of the mesh a patch of its own. Every edge of the mesh is in two triangles.
    Patches(const Mesh& mesh, const std::vector<Origin>& origins);

    /// Follows a change; `fresh` are the numbers of the facets that it added.
    void change(const Change& change, const std::vector<int>& fresh);
    /// Joins the patches of these facets, because something that they share has changed.
    void join(std::span<const int> facets);
    /// Follows a renumbering of the mesh: `facets`, `vertices` and `normals` hold the old number of everything that is
    /// left.
    void renumber(const std::vector<int>& facets, const std::vector<int>& vertices, const std::vector<int>& normals);

    /// Replaces facets of `fresh` by what became of the same facets in `mesh`, the mesh that these patches belong to.
    /// That is done for patches all of whose sources are in `fresh` (with the same bits of corners and the same
    /// origins), and that hold none of the triangles `but` of `mesh`. Returns the patches of the resulting `fresh`,
    /// which may contain unused vertices.
    Patches put_into(Mesh& fresh, std::vector<Origin>& fresh_origins, const Mesh& mesh,
                     const std::vector<Origin>& origins, std::span<const int> but) const;

private:
    class Insertion;

    // A facet at the start.
    struct Source {
        FacetKey key;
        std::array<int, 3> vertex, normal;
    };

    std::vector<Source> sources_;
    UnionFind joined_;                     // sources of one patch
    std::vector<int> source_;              // for each present facet, one source of its patch
    std::vector<int> vertices_, normals_;  // for each present vertex and normal, its number at the start; −1: added
                                           // since
};

}  // namespace deburr
