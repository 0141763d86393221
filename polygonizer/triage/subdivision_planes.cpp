// By which plane a cell is cut next: the one that leaves the fewest half-spaces to deal with.
#include <algorithm>

#include "polygonizer/triage/density_side.hpp"
#include "polygonizer/triage/parallel_family.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

// Half-spaces left to deal with on one side of a plane with this offset and the normal that reach_ was
// turned to; 0 where the solid is decided.
double Subdivision::cost(const Place& place, double offset, bool above) {
    std::size_t first = 0;
    double left = 0;
    for (std::size_t k = 0; k < place.open.size(); ++k) {
        const LocalDensity& density = *place.open[k].density;
        const std::size_t count = density.half_spaces().size();
        std::size_t varying = varying_[k];
        for (std::size_t i = first; i < first + count; ++i) {
            const Reach& reach = reach_[i];
            if (reach.along == 0) continue;
            const HalfSpace& h = *reach.half_space;
            const double at = offset * reach.along - h.offset;
            ranges_[i] = reach.rho;
            if ((reach.along > 0) != above) {
                if (at < reach.distance.hi) ranges_[i].lo = least_rho(h, at, complex.tolerance);
            } else if (at > reach.distance.lo) {
                ranges_[i].hi = greatest_rho(h, at, complex.tolerance);
            }
            varying += varies(ranges_[i]);
        }
        sides_[k] = decide(density.range(std::span(ranges_).subspan(first, count)));
        if (sides_[k] == Side::straddling) left += 1.0 + double(varying);
        first += count;
    }
    if (left == 0) return 0;
    if (place.open.size() > 1) {
        std::vector<SolidTreeNode> solid = place.solid;
        const Side side = fold(solid, [&](int leaf) {
            for (std::size_t k = 0; k < place.open.size(); ++k)
                if (place.open[k].leaf == leaf) return sides_[k];
            return Side::straddling;
        });
        if (side != Side::straddling) return 0;
    }
    return left;
}

// Makes ready for planes of this normal.
void Subdivision::turn(const Place& place, Vec3 normal) {
    if (normal == -turned_to_)
        for (Reach& reach : reach_) reach.along = -reach.along;
    const bool is_along = normal == turned_to_ || normal == -turned_to_;
    turned_to_ = normal;
    if (is_along) return;
    ranges_.clear();
    varying_.assign(place.open.size(), 0);
    sides_.resize(place.open.size());
    auto reach = reach_.begin();
    for (std::size_t k = 0; k < place.open.size(); ++k)
        for (std::size_t count = place.open[k].density->half_spaces().size(); count > 0; --count, ++reach) {
            const double cosine = glm::dot(reach->half_space->normal, normal);
            reach->along = std::abs(cosine) > 1 - 1e-12 ? (cosine > 0 ? 1 : -1) : 0;
            ranges_.push_back(reach->rho);
            if (reach->along == 0) varying_[k] += varies(reach->rho);
        }
}

bool Subdivision::is_refused(const Plane& plane) const {
    for (const Plane& r : refused_[std::size_t(current_)])
        if (r.normal == plane.normal && r.offset == plane.offset) return true;
    return false;
}

bool Subdivision::choose(const Place& place, Plane& plane) {
    std::size_t half_spaces = 0;
    bool all_small = true;
    for (const OpenLeaf& leaf : place.open) {
        half_spaces += leaf.tree->half_spaces.size();
        all_small &= leaf.density != nullptr;
    }
    if ((half_spaces > many || !all_small) && choose_neutral(place, plane)) return true;
    if (!all_small) return false;

    candidates_.clear();
    const auto consider = [&](const Plane& p, Range s, double bias) {
        if (s.hi - p.offset <= complex.tolerance || p.offset - s.lo <= complex.tolerance) return;
        if (!is_refused(p)) candidates_.push_back({p, s, bias});
    };
    for (const OpenLeaf& leaf : place.open) {
        const auto& planes = leaf.density->half_spaces();
        if (is_parallel_family(*leaf.density)) {
            const Range s = extent(planes[0].normal);
            for (const Plane& p : level_planes(*leaf.density, s, complex.tolerance).planes) consider(p, s, 0);
            continue;
        }
        for (const HalfSpace& h : planes) {
            const Range s = extent(h.normal);
            consider({h.normal, h.offset}, s, 0);
            if (h.radius == 0) continue;
            consider({h.normal, h.offset + h.radius}, s, 0.5);
            consider({h.normal, h.offset - h.radius}, s, 0.5);
        }
    }
    if (candidates_.empty()) return false;
    plane = candidates_[0].plane;
    if (candidates_.size() == 1) return true;

    reach_.clear();
    turned_to_ = Vec3(0.0);
    for (const OpenLeaf& leaf : place.open)
        for (const HalfSpace& h : leaf.density->half_spaces()) {
            const Range d = distances(h);
            reach_.push_back({&h, d, rho_between(h, d.lo, d.hi, complex.tolerance), 0});
        }
    double best = infinity;
    for (const auto& [p, s, bias] : candidates_) {
        turn(place, p.normal);
        const double share = (s.hi - p.offset) / (s.hi - s.lo);
        const double above = cost(place, p.offset, true) * std::sqrt(share);
        if (above + bias >= best) continue;
        const double c = above + cost(place, p.offset, false) * std::sqrt(1 - share) + bias;
        if (c >= best) continue;
        best = c;
        plane = p;
    }
    return true;
}

// Across the longest side of the cell, at a half-space's own plane if one is near the middle.
bool Subdivision::choose_neutral(const Place& place, Plane& plane) const {
    Box box;
    for (const Vec3& x : corners_) box = hull(box, Box{x, x});
    const Vec3 size = box.hi - box.lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    double least = infinity;
    for (const OpenLeaf& leaf : place.open)
        for (const HalfSpace& h : leaf.tree->half_spaces)
            if (h.radius > 0) least = std::min(least, h.radius);
    // Where many half-spaces vary together in a cell smaller than their filter, halving no longer
    // tells them apart.
    constexpr double smallest = 0.5;        // in radii
    constexpr double sharp_smallest = 1e5;  // in tolerances
    if (size[axis] <= (least < infinity ? smallest * least : sharp_smallest * complex.tolerance)) return false;
    const double middle = 0.5 * (box.lo[axis] + box.hi[axis]);
    plane.normal = Vec3(0.0);
    plane.normal[axis] = 1;
    plane.offset = middle;
    double nearest = 0.2 * size[axis];
    for (const OpenLeaf& leaf : place.open)
        for (const HalfSpace& h : leaf.tree->half_spaces) {
            if (std::abs(h.normal[axis]) < 1 - 1e-12) continue;
            for (const double shift : {-h.radius, 0.0, h.radius}) {
                const double at = (h.offset + shift) * (h.normal[axis] > 0 ? 1 : -1);
                if (std::abs(at - middle) >= nearest) continue;
                nearest = std::abs(at - middle);
                plane.offset = at;
            }
        }
    return !is_refused(plane);
}

}  // namespace deburr
