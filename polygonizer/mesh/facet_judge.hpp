// How the facets of a mesh lie to the solid that they stand for.
#pragma once
#include <array>

#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/mesh/leaf_surfaces.hpp"

namespace deburr {

struct FacetShape {
    double own = 1;       // cosine to its own surface at its middle; −1 without area
    double cosine = 1;    // the same, or to the solid's surface that is nearest to the middle if that is less
    double distance = 0;  // of the middle from the solid's surface; 0 where the density is saturated
    bool saturated = false;
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
    /// Whether points all over the triangle are within the tolerance of the solid's surface: its middle, those of
    /// is_near_within, and those of is_near_between on each edge.
    bool is_near(const std::array<Vec3, 3>& corners, double tolerance) const;
    /// The same for the three points half-way between the triangle's middle and its corners.
    bool is_near_within(const std::array<Vec3, 3>& corners, double tolerance) const;
    /// The same for the three points that divide the edge from a to b in four.
    bool is_near_between(Vec3 a, Vec3 b, double tolerance) const;
    bool on_surface(Vec3 x) const { return std::abs(solid_.at(x).distance) <= 10 * surfaces_.slack(); }
    const DistanceField& solid() const { return solid_; }
    const LeafSurfaces& surfaces() const { return surfaces_; }
    /// Length of the diagonal of the box around the mesh.
    double size() const { return size_; }

private:
    bool is_point_near(Vec3 x, double tolerance) const;

    DistanceField solid_;
    bool one_leaf_;
    LeafSurfaces surfaces_;
    double size_;
    bool in_single_;  // facets are judged as single precision rounds them, too
};

}  // namespace deburr
