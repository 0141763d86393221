#include "polygonizer/mesh/leaf_surfaces.hpp"

namespace deburr {

LeafSurfaces::LeafSurfaces(const SolidTree& solid, const Box& box, const DistanceField* only)
    : solid_(solid), box_(box), slack_(1e-10 * glm::length(box.hi - box.lo)), only_(only) {
    fields_.resize(solid.leaves.size());
}

SurfaceSample LeafSurfaces::at(const LeafSurface& piece, Vec3 x) const {
    if (piece.leaf < 0) return {piece.offset - glm::dot(piece.normal, x), piece.normal, -1};
    if (only_) {
        SurfaceSample o = only_->at(x);
        o.leaf = piece.leaf;
        return o;
    }
    auto& field = fields_[piece.leaf];
    if (!field) {
        SolidTree alone;
        alone.leaves.push_back(solid_.leaves[piece.leaf]);
        alone.nodes.push_back({SolidOp::leaf, 0, -1});
        field = std::make_unique<DistanceField>(alone, box_);
    }
    SurfaceSample o = field->at(x);
    o.leaf = piece.leaf;
    return o;
}

bool LeafSurfaces::project(Vec3& x, const std::vector<LeafSurface>& pieces, double reach) const {
    constexpr int steps = 30;         // Newton's method usually takes 4
    constexpr double tangent = 1e-4;  // sine of the angle below which surfaces count as touching
    Vec3 at_x = x;
    double last = infinity;
    for (int step = 0; step < steps; ++step) {
        Vec3 basis[3], move(0.0);
        std::size_t count = 0;
        double worst = 0;
        for (const LeafSurface& piece : pieces) {
            const SurfaceSample o = at(piece, at_x);
            if (!std::isfinite(o.distance) || o.normal == Vec3(0.0)) return false;
            worst = std::max(worst, std::abs(o.distance));
            Vec3 rest = o.normal;
            for (std::size_t k = 0; k < count; ++k) rest -= basis[k] * glm::dot(basis[k], rest);
            const double length = glm::length(rest);
            if (count == 3 || length < tangent) continue;
            // The distance grows against the normal.
            basis[count] = rest / length;
            move += basis[count] * ((o.distance - glm::dot(o.normal, move)) / length);
            ++count;
        }
        at_x += move;
        if (!(glm::length(at_x - x) <= reach)) return false;
        if (worst <= slack_ && worst >= 0.5 * last) {
            x = at_x;
            return true;
        }
        if (worst <= 1e-6 * slack_) {
            x = at_x;
            return true;
        }
        last = worst;
    }
    return false;
}

}  // namespace deburr
