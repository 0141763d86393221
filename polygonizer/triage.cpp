#include "polygonizer/triage.hpp"

#include "bounds/bounding_box.hpp"
#include "polygonizer/surface.hpp"

namespace deburr {

Box polygonization_box(const SolidTree& solid) {
    Box box = bounding_box(solid);
    if (box.empty()) return box;
    double size = 0;
    for (int k = 0; k < 3; ++k)
        if (std::isfinite(box.hi[k] - box.lo[k])) size = std::max(size, box.hi[k] - box.lo[k]);
    if (size == 0) size = 1;
    // A side that is infinite ends this many sizes away from what is finite.
    constexpr double reach = 10;
    for (int k = 0; k < 3; ++k) {
        const bool lo = std::isfinite(box.lo[k]), hi = std::isfinite(box.hi[k]);
        if (!lo && !hi) box.lo[k] = -reach * size, box.hi[k] = reach * size;
        else if (!lo) box.lo[k] = box.hi[k] - reach * size;
        else if (!hi) box.hi[k] = box.lo[k] + reach * size;
        else {
            box.lo[k] -= 0.05 * size;
            box.hi[k] += 0.05 * size;
        }
    }
    return box;
}

Mesh triage(const SolidTree& solid, const Box& box, const TriageOptions& options, TriageStatistics* statistics) {
    (void)options;
    if (box.empty()) return {};
    Subdivision subdivision(solid, box);
    if (statistics) {
        statistics->cells = subdivision.complex.cells.size();
        for (std::size_t c = 0; c < subdivision.complex.cells.size(); ++c)
            statistics->open_cells +=
                subdivision.places[std::size_t(subdivision.place_of[c])].side == Side::straddling;
    }
    Subspace subspace(subdivision);
    subspace.polygonize();
    return surface(subspace, subdivision, solid);
}

}  // namespace deburr
