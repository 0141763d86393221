// How the facets of a mesh lie to the solid that they stand for.
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/mesh/leaf_surfaces.hpp"

namespace deburr {

struct FacetShape {
    double own = 1;       // cosine to its own surface at its middle; −1 without area
    double cosine = 1;    // the same, or to the solid's surface that is nearest to the middle if that is less
    double distance = 0;  // of the middle from the solid's surface
};

/// The solid as it is seen from the facets of a mesh: from the middle of each the surface that it stands
/// for, and all that are nearer.
DistanceField field_around(const Mesh& mesh, const SolidTree& solid);

/// Judges facets of any mesh of one solid. One thread at a time may use it.
class FacetJudge {
public:
    /// `mesh` tells where the surfaces are.
    FacetJudge(const SolidTree& solid, const Mesh& mesh);
    FacetJudge(const FacetJudge&) = delete;
    FacetJudge& operator=(const FacetJudge&) = delete;

    /// Shape of facet f. Once its own cosine is found to be below `least`, the rest is not looked at.
    FacetShape shape(const Facets& facets, const Facet& f, double least = -infinity) const;
    /// Whether points all over the triangle are within the tolerance of the solid's surface: its middle, three around
    /// that, and three on each edge, but for edges that do not end at corner `only` where that is not −1.
    bool is_near(const Vec3 (&corners)[3], double tolerance, int only = -1) const;
    bool on_surface(Vec3 x) const { return std::abs(solid_.at(x).distance) <= 10 * surfaces_.slack(); }
    const DistanceField& solid() const { return solid_; }
    const LeafSurfaces& surfaces() const { return surfaces_; }
    /// Length of the diagonal of the box around the mesh.
    double size() const { return size_; }

private:
    DistanceField solid_;
    bool one_leaf_;
    LeafSurfaces surfaces_;
    double size_;
    bool in_single_;  // facets are judged as single precision rounds them, too
};

}  // namespace deburr
