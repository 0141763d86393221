#include "polygonizer/mesh/facet_orientation.hpp"

namespace deburr {
namespace {

// Steps along the line, to both sides in turn, grow from this fraction of the reach.
constexpr double first_step = 1e-7, growth = 1.25;
// Nearer to the surface than this fraction of the reach there may be several surfaces at once.
constexpr double beside_surface = 1e-9;

}  // namespace

bool faces_outward(const DistanceField& solid, Vec3 x, const SurfaceSample& here, Vec3 normal, Vec3 otherwise,
                   double reach) {
    if (std::abs(here.distance) > beside_surface * reach && glm::dot(normal, here.normal) > 0) return true;
    for (double step = first_step * reach; step <= reach; step *= growth) {
        const bool before = solid.inside(x + normal * step), behind = solid.inside(x - normal * step);
        if (before != behind) return behind;
    }
    return glm::dot(normal, otherwise) > 0;
}

}  // namespace deburr
