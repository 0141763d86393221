// Chooses the plane by which a cell is cut next: the one that leaves the fewest half-spaces to deal with.
#include <algorithm>

#include "bounds/decision_diagram.hpp"
#include "polygonizer/triage/density_side.hpp"
#include "polygonizer/triage/parallel_family.hpp"
#include "polygonizer/triage/simple_cell.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

// The number of half-spaces left on one side of the plane with this offset and the normal that reach_ is turned to; 0
// if the solid is decided there.
double Subdivision::cost(const PartitionNode& node, double offset, bool above) {
    std::size_t first = 0;
    double left = 0;
    for (std::size_t k = 0; k < node.open.size(); ++k) {
        const LocalDensity& density = *node.open[k].density;
        const std::size_t count = density.half_spaces().size();
        std::size_t varying = varying_[k];
        for (std::size_t i = first; i < first + count; ++i) {
            const Reach& reach = reach_[i];
            if (reach.along == 0) continue;
            const HalfSpace& h = *reach.half_space;
            const double at = offset * reach.along - h.offset;
            ranges_[i] = reach.rho;
            if ((reach.along > 0) != above) {
                if (at < reach.distance.hi) ranges_[i].lo = min_rho(h, at, complex.tolerance);
            } else if (at > reach.distance.lo) {
                ranges_[i].hi = max_rho(h, at, complex.tolerance);
            }
            varying += varies(ranges_[i]);
        }
        sides_[k] = classify_with_slack(density.range(std::span(ranges_).subspan(first, count)));
        if (sides_[k] == Side::straddling) left += 1.0 + double(varying);
        first += count;
    }
    if (left == 0) return 0;
    if (node.open.size() > 1) {
        std::vector<SolidTreeNode> solid = node.solid;
        const Side side = fold(solid, [&](int leaf) {
            for (std::size_t k = 0; k < node.open.size(); ++k)
                if (node.open[k].leaf == leaf) return sides_[k];
            return Side::straddling;
        });
        if (side != Side::straddling) return 0;
    }
    return left;
}

// Prepares cost() for planes with this normal.
void Subdivision::turn(const PartitionNode& node, Vec3 normal) {
    if (normal == -turned_to_)
        for (Reach& reach : reach_) reach.along = -reach.along;
    const bool is_along = normal == turned_to_ || normal == -turned_to_;
    turned_to_ = normal;
    if (is_along) return;
    ranges_.clear();
    varying_.assign(node.open.size(), 0);
    sides_.resize(node.open.size());
    auto reach = reach_.begin();
    for (std::size_t k = 0; k < node.open.size(); ++k)
        for (std::size_t count = node.open[k].density->half_spaces().size(); count > 0; --count, ++reach) {
            const double cosine = glm::dot(reach->half_space->normal, normal);
            reach->along = std::abs(cosine) > 1 - 1e-12 ? (cosine > 0 ? 1 : -1) : 0;
            ranges_.push_back(reach->rho);
            if (reach->along == 0) varying_[k] += varies(reach->rho);
        }
}

bool Subdivision::is_refused(const Plane& plane) const {
    for (const Plane& r : refused_[current_])
        if (r.normal == plane.normal && r.offset == plane.offset) return true;
    return false;
}

// Measures the current cell against the filter.
Subdivision::Extents Subdivision::extents(const PartitionNode& node) const {
    Extents e;
    for (const Vec3& x : corners_) e.box = hull(e.box, Box{x, x});
    Vec3 size = e.box.hi - e.box.lo, across(0.0);
    for (const OpenLeaf& leaf : node.open) {
        e.half_spaces += leaf.tree->half_spaces.size();
        e.all_small &= leaf.density != nullptr;
        for (const HalfSpace& h : leaf.tree->half_spaces) {
            // A rounded mesh is constant along a direction only if all of its planes contain that exactly.
            constexpr double exactly = 1e-9;
            const Vec3 n = glm::abs(h.normal);
            across += leaf.field ? Vec3(n.x > exactly, n.y > exactly, n.z > exactly) : n;
            if (h.radius > 0) e.radius = std::min(e.radius, h.radius);
        }
    }
    // Along a sweep nothing changes.
    if (e.half_spaces <= many) size *= glm::min(across, Vec3(1.0));
    for (const OpenLeaf& leaf : node.open)
        for (const HalfSpace& h : leaf.tree->half_spaces) {
            const Range along = extent_along(h.normal, corners_);
            if (along.hi - along.lo <= e.width) continue;
            e.width = along.hi - along.lo;
            e.widest = {h.normal, 0.5 * (along.lo + along.hi)};
        }
    // Where many half-spaces meet, a cut across an axis that few of their normals have leaves most of them on both
    // sides.
    constexpr double least_weight = 0.25;
    Vec3 weighed = size;
    if (e.half_spaces > many)
        for (int k = 0; k < 3; ++k)
            weighed[k] *= across[k] > 0 ? std::max(across[k] / largest(across), least_weight) : 0.0;
    e.axis = greatest_axis(weighed);
    e.size = size[e.axis];
    return e;
}

// Whether every open leaf is simple throughout the cell.
bool Subdivision::is_simple_cell(const PartitionNode& node) const {
    return std::all_of(node.open.begin(), node.open.end(), [&](const OpenLeaf& leaf) {
        return leaf.density && is_simple(*leaf.density, corners_, complex.tolerance);
    });
}

// Whether some open leaf has corners of the cell on both sides of its surface.
bool Subdivision::shows_surface(const PartitionNode& node) const {
    return std::any_of(node.open.begin(), node.open.end(), [&](const OpenLeaf& leaf) {
        if (!leaf.density) return false;
        bool above = false, below = false;
        for (const Vec3& x : corners_) {
            (leaf.density->at(x) > 0.5 ? above : below) = true;
            if (above && below) return true;
        }
        return false;
    });
}

// Prepares densities that were put off; false if a diagram would be too large, so that smaller cells are needed.
bool Subdivision::make_densities(PartitionNode& node) {
    for (OpenLeaf& leaf : node.open) try {
            if (!leaf.density) leaf.density = density_of(leaf);
        } catch (const TooEntangled&) {
            return false;
        }
    return true;
}

bool Subdivision::choose(PartitionNode& node, Plane& plane) {
    Extents cell = extents(node);
    // Where many half-spaces vary together in a cell that is not much larger than their filters, few of their planes
    // would separate flat faces from the rest, and all of them together would cut it into many cells.
    constexpr double small = 4;  // in radii, across any of the planes: two filters
    // Round parts of a mesh model have a plane for every facet, which separates nothing.
    constexpr std::size_t many_of_mesh = 2;
    const bool is_small = std::min(cell.width, largest(cell.box.hi - cell.box.lo)) <= small * cell.radius;
    const bool of_mesh =
        std::any_of(node.open.begin(), node.open.end(), [](const OpenLeaf& l) { return l.field != nullptr; });
    // Where very many half-spaces reach everywhere, no cell of that size has few of them.
    if (!cell.all_small && !of_mesh && is_small && cell.radius < infinity) cell.all_small = make_densities(node);
    const bool crowded = cell.half_spaces > (of_mesh ? many_of_mesh : many);
    if (cell.all_small && crowded && is_small && is_simple_cell(node)) return false;
    if (crowded && !of_mesh && choose_outer(node, cell, plane)) return true;
    if ((crowded || !cell.all_small) && choose_neutral(node, cell, plane)) return true;
    if (!cell.all_small) return false;
    if (choose_own(node, plane)) return true;
    // No plane is left. A part of the surface that the cell's corners do not show may lie wholly within.
    return !shows_surface(node) && !is_simple_cell(node) && choose_neutral(node, cell, plane);
}

// Sets reach_ for cost().
void Subdivision::reach_of(const PartitionNode& node) {
    reach_.clear();
    turned_to_ = Vec3(0.0);
    for (const OpenLeaf& leaf : node.open)
        for (const HalfSpace& h : leaf.density->half_spaces()) {
            const Range d = distances(h);
            reach_.push_back({&h, d, rho_between(h, d.lo, d.hi, complex.tolerance), 0});
        }
}

// Chooses, for a cell that is large against the filter, a parallel plane at ±r beyond which much of the cell is
// decided. Without such planes a rod of many sides at a slant would be cut into as many cells as its length has of its
// width.
bool Subdivision::choose_outer(const PartitionNode& node, const Extents& cell, Plane& plane) {
    constexpr double large = 64;            // in radii
    constexpr double least_share = 0.25;    // relative to the cell's extent along the plane's normal
    constexpr std::size_t max_count = 128;  // greatest number of half-spaces for which this is tried
    if (!(cell.size > large * cell.radius) || cell.half_spaces > max_count) return false;
    PartitionNode ready = node;  // a copy, so that densities that were put off stay so
    if (!cell.all_small && !make_densities(ready)) return false;
    reach_of(ready);
    double most = least_share;
    for (const OpenLeaf& leaf : ready.open)
        for (const HalfSpace& h : leaf.density->half_spaces()) {
            const Range s = extent(h.normal);
            for (const bool above : {true, false}) {
                const Plane p{h.normal, h.offset + (above ? h.radius : -h.radius)};
                const double share = (above ? s.hi - p.offset : p.offset - s.lo) / (s.hi - s.lo);
                if (!(share > most && share < 1) || is_refused(p)) continue;
                turn(ready, p.normal);
                if (cost(ready, p.offset, above) > 0) continue;
                most = share;
                plane = p;
            }
        }
    return most > least_share;
}

// Chooses a plane of the half-spaces in the cell, or one of their parallels at ±r.
bool Subdivision::choose_own(const PartitionNode& node, Plane& plane) {
    candidates_.clear();
    const auto consider = [&](const Plane& p, Range s, double bias) {
        if (s.hi - p.offset <= complex.tolerance || p.offset - s.lo <= complex.tolerance) return;
        if (!is_refused(p)) candidates_.push_back({p, s, bias});
    };
    for (const OpenLeaf& leaf : node.open) {
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

    reach_of(node);
    double best = infinity;
    for (const auto& [p, s, bias] : candidates_) {
        turn(node, p.normal);
        const double share = (s.hi - p.offset) / (s.hi - s.lo);
        const double above = cost(node, p.offset, true) * std::sqrt(share);
        if (above + bias >= best) continue;
        const double c = above + cost(node, p.offset, false) * std::sqrt(1 - share) + bias;
        if (c >= best) continue;
        best = c;
        plane = p;
    }
    return true;
}

// Chooses a plane across the longest side of the cell; that of a half-space, if one is near the middle.
bool Subdivision::choose_neutral(const PartitionNode& node, const Extents& cell, Plane& plane) const {
    // A cell of the smallest size may hold several sheets, but only of a surface that its corners show; any other part
    // is so small that it is given up.
    constexpr double smallest_seen = 1, smallest_unseen = 0.125;  // in radii
    constexpr double sharp_smallest = 1e5;                        // in tolerances
    // A cell whose longest side exceeds its greatest width across planes by this factor lies along a sweep.
    constexpr double slender = 4;
    const bool is_slender = cell.width > 0 && cell.size > slender * cell.width;
    const double size = is_slender ? cell.width : cell.size, radius = cell.radius;
    const int axis = cell.axis;
    const Box& box = cell.box;
    if (radius == infinity) {
        if (size <= sharp_smallest * complex.tolerance) return false;
    } else if (size <= smallest_unseen * radius || (size <= smallest_seen * radius && shows_surface(node))) {
        return false;
    }
    if (is_slender) {
        plane = cell.widest;
        return !is_refused(plane);
    }
    const double middle = 0.5 * (box.lo[axis] + box.hi[axis]);
    plane.normal = Vec3(0.0);
    plane.normal[axis] = 1;
    plane.offset = middle;
    double nearest = 0.2 * (box.hi[axis] - box.lo[axis]);
    for (const OpenLeaf& leaf : node.open)
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
