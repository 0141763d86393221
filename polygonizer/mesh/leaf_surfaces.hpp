// The individual surfaces that a mesh consists of: isosurfaces of leaves, and planes. A vertex on a seam lies on two of
// them, one at a corner on three.
#pragma once
#include <memory>
#include <vector>

#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// The isosurface of a leaf, or where leaf is −1 the plane n·x = offset.
struct LeafSurface {
    int leaf = -1;
    Vec3 normal{0.0};
    double offset = 0;
};

/// The surfaces of a solid's leaves within a box. Not for several threads at once.
class LeafSurfaces {
public:
    /// `only` is the field of the whole solid if that is a single leaf, else null. Keeps references to `solid` and to
    /// `only`.
    LeafSurfaces(const SolidTree& solid, const Box& box, const DistanceField* only = nullptr);

    /// Signed distance of x from the surface to first order, and the outward normal; > 0 inside the leaf or behind the
    /// plane.
    SurfaceSample at(const LeafSurface& piece, Vec3 x) const;
    /// Moves x to where all `pieces` meet, by Newton's method with the shortest possible steps, at most by the distance
    /// `reach`. Returns false and leaves x as it is if that does not lead onto all of them. Pieces that touch each
    /// other there count as one.
    bool project(Vec3& x, const std::vector<LeafSurface>& pieces, double reach) const;
    /// The distance below which a point counts as on a surface.
    double slack() const { return slack_; }

private:
    const SolidTree& solid_;
    Box box_;
    double slack_;
    const DistanceField* only_;
    mutable std::vector<std::unique_ptr<DistanceField>> fields_;
};

}  // namespace deburr
