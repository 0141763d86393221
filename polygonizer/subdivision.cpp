#include "polygonizer/subdivision.hpp"

#include <algorithm>
#include <cassert>

#include "bounds/solid_range.hpp"
#include "polygonizer/parallel_family.hpp"

namespace deburr {
namespace {

// With more half-spaces than this in a cell it is halved along an axis first: chosen, near the
// minimum of the triangle count over Lobb's figures.
constexpr std::size_t many = 14;

// ρ ranges this near to ½ count as ending there: they come from α = 0 to within a few ε.
constexpr double level_slack = 1e-12;

Side decide(Range rho) {
    if (rho.hi <= 0.5 + level_slack) return Side::outside;
    if (rho.lo >= 0.5 - level_slack) return Side::inside;
    return Side::straddling;
}

bool is_decided(Range rho) { return decide(rho) != Side::straddling; }

// Distances that a vertex snapped to h or h ± r should have had.
double snapped(double distance, double radius, double tolerance) {
    for (const double plane : {-radius, 0.0, radius})
        if (std::abs(distance - plane) <= tolerance) return plane;
    return distance;
}

// ρ between two distances: the least is at the greater of them. A sharp one is constant on either closed side.
double least_rho(const HalfSpace& h, double hi, double tolerance) {
    hi = snapped(hi, h.radius, tolerance);
    return h.radius > 0 ? profile(hi / h.radius) : hi > 0 ? 0.0 : 1.0;
}
double greatest_rho(const HalfSpace& h, double lo, double tolerance) {
    lo = snapped(lo, h.radius, tolerance);
    return h.radius > 0 ? profile(lo / h.radius) : lo >= 0 ? 0.0 : 1.0;
}
Range rho_between(const HalfSpace& h, double lo, double hi, double tolerance) {
    return {least_rho(h, hi, tolerance), greatest_rho(h, lo, tolerance)};
}

bool varies(Range rho) { return rho.hi != 0 && rho.lo != 1; }

// Folds decided leaves away; `solid` keeps children before parents, the root last.
template <class SideOfLeaf>
Side fold(std::vector<SolidTreeNode>& solid, SideOfLeaf side_of_leaf) {
    if (solid.size() == 1 && solid[0].op == SolidOp::leaf) {
        const Side side = side_of_leaf(solid[0].a);
        if (side != Side::straddling) solid.clear();
        return side;
    }
    std::vector<Side> sides;
    for (const SolidTreeNode& n : solid) {
        switch (n.op) {
            case SolidOp::nothing: sides.push_back(Side::outside); break;
            case SolidOp::everything: sides.push_back(Side::inside); break;
            case SolidOp::leaf: sides.push_back(side_of_leaf(n.a)); break;
            default: sides.push_back(combine(n.op, sides[std::size_t(n.a)], sides[std::size_t(n.b)]));
        }
    }
    const Side root = sides.back();
    if (root != Side::straddling) {
        solid.clear();
        return root;
    }
    if (solid.size() == 1) return root;
    std::vector<char> needed(solid.size(), false);
    needed.back() = true;
    for (std::size_t i = solid.size(); i-- > 0;) {
        if (!needed[i] || sides[i] != Side::straddling || solid[i].op == SolidOp::leaf) continue;
        needed[std::size_t(solid[i].a)] = needed[std::size_t(solid[i].b)] = true;
    }
    std::vector<int> place(solid.size(), -1);
    std::vector<SolidTreeNode> to;
    for (std::size_t i = 0; i < solid.size(); ++i) {
        if (!needed[i]) continue;
        SolidTreeNode n = solid[i];
        if (sides[i] != Side::straddling) {
            n = {sides[i] == Side::inside ? SolidOp::everything : SolidOp::nothing};
        } else if (n.op != SolidOp::leaf) {
            const bool a_open = sides[std::size_t(n.a)] == Side::straddling;
            const bool b_open = sides[std::size_t(n.b)] == Side::straddling;
            if (!b_open || (!a_open && n.op != SolidOp::subtract)) {
                place[i] = place[std::size_t(b_open ? n.b : n.a)];
                continue;
            }
            n.a = place[std::size_t(n.a)];
            n.b = place[std::size_t(n.b)];
        }
        place[i] = int(to.size());
        to.push_back(n);
    }
    to.resize(std::size_t(place.back()) + 1);
    solid = std::move(to);
    return root;
}

}  // namespace

Subdivision::Subdivision(const SolidTree& solid, const Box& box)
    : complex(box, 1e-9 * glm::length(box.hi - box.lo)) {
    Place whole;
    whole.solid = solid.nodes;
    for (std::size_t k = 0; k < solid.leaves.size(); ++k)
        whole.open.push_back({int(k), std::make_shared<DensityTree>(solid.leaves[k].density), nullptr});
    places.push_back(std::move(whole));
    refused_.emplace_back();
    place_of.push_back(0);
    place_of[0] = new_place(0, 0);
    subdivide(0);
}

// Of corners_, along a normal.
Range Subdivision::extent(Vec3 normal) {
    for (const Extent& e : extents_) {
        if (e.normal == normal) return e.along;
        if (e.normal == -normal) return {-e.along.hi, -e.along.lo};
    }
    const Range along = extent_along(normal, corners_);
    constexpr std::size_t usual = 8;  // normals; what has more would look for them too long
    if (extents_.size() < usual) extents_.push_back({normal, along});
    return along;
}

// Rounding is monotone: the least of differences is the difference from the least.
Range Subdivision::distances(const HalfSpace& h) {
    const Range s = extent(h.normal);
    return {s.lo - h.offset, s.hi - h.offset};
}

// ρ of the half-spaces over corners_, to ranges_.
void Subdivision::range_over_cell(const std::vector<HalfSpace>& half_spaces) {
    ranges_.clear();
    for (const HalfSpace& h : half_spaces) {
        const Range d = distances(h);
        ranges_.push_back(rho_between(h, d.lo, d.hi, complex.tolerance));
    }
}

// The leaf within corners_.
OpenLeaf Subdivision::localize(const OpenLeaf& leaf, Side& side) {
    range_over_cell(leaf.tree->half_spaces);
    Pruned pruned = prune_further(*leaf.tree, ranges_, is_decided);
    side = decide(pruned.range);
    if (side != Side::straddling) return leaf;
    OpenLeaf local = leaf;
    if (!pruned.tree.nodes.empty()) {
        local.tree = std::make_shared<DensityTree>(std::move(pruned.tree));
        local.density = nullptr;
    }
    // Part of a cell that was small enough, or that nothing more divides: small enough too.
    if (!local.density && (leaf.density || local.tree->half_spaces.size() <= 2 * many))
        local.density = std::make_shared<LocalDensity>(*local.tree);
    if (local.density) {
        range_over_cell(local.density->half_spaces());
        side = decide(local.density->range(ranges_));
        if (side == Side::straddling && is_parallel_family(*local.density)) {
            const Range s = extent(local.density->half_spaces()[0].normal);
            const auto roots = level_planes(*local.density, s, complex.tolerance);
            if (roots.planes.empty()) side = roots.inside ? Side::inside : Side::outside;
        }
    }
    return local;
}

void Subdivision::look_at(int cell) {
    const std::pair now{cell, complex.cells.size()};
    if (looked_at_ == now) return;
    looked_at_ = now;
    corners_.clear();
    extents_.clear();
    for (int v : complex.vertices_of(cell)) corners_.push_back(complex.vertices[std::size_t(v)]);
}

int Subdivision::new_place(int parent, int cell) {
    look_at(cell);
    Place place;
    place.parent = parent;
    place.solid = places[std::size_t(parent)].solid;
    for (const OpenLeaf& leaf : places[std::size_t(parent)].open) {
        Side side;
        OpenLeaf local = localize(leaf, side);
        if (side == Side::straddling) place.open.push_back(std::move(local));
        else place.decided.push_back({leaf.leaf, side});
    }
    place.side = fold(place.solid, [&](int leaf) {
        for (const auto& [decided, side] : place.decided)
            if (decided == leaf) return side;
        return Side::straddling;
    });
    std::erase_if(place.open, [&](const OpenLeaf& leaf) {
        return std::none_of(place.solid.begin(), place.solid.end(),
                            [&](const SolidTreeNode& n) { return n.op == SolidOp::leaf && n.a == leaf.leaf; });
    });
    places.push_back(std::move(place));
    return int(places.size()) - 1;
}

Side Subdivision::side(int cell, int leaf) const {
    for (int p = place_of[std::size_t(cell)]; p >= 0; p = places[std::size_t(p)].parent) {
        const auto& decided = places[std::size_t(p)].decided;
        const auto at = std::lower_bound(decided.begin(), decided.end(), std::pair{leaf, Side::outside});
        if (at != decided.end() && at->first == leaf) return at->second;
    }
    return Side::straddling;
}

const OpenLeaf* Subdivision::open(int cell, int leaf) const {
    for (const OpenLeaf& o : places[std::size_t(place_of[std::size_t(cell)])].open)
        if (o.leaf == leaf) return &o;
    return nullptr;
}

bool Subdivision::halve(int cell, const Plane& plane) {
    const int upper = complex.cut(cell, plane);
    if (upper < 0) return false;
    const int parent = place_of[std::size_t(cell)];
    refused_.push_back(refused_[std::size_t(cell)]);
    place_of.push_back(new_place(parent, upper));
    place_of[std::size_t(cell)] = new_place(parent, cell);
    return true;
}

void Subdivision::subdivide(int cell) {
    std::vector<int> todo{cell};
    while (!todo.empty()) {
        current_ = todo.back();
        todo.pop_back();
        const int at = place_of[std::size_t(current_)];
        if (places[std::size_t(at)].side != Side::straddling) continue;
        look_at(current_);
        Plane plane{};
        if (!choose(places[std::size_t(at)], plane)) {
            // Cells of a filter that reaches all over the object stay large, with many half-spaces.
            for (OpenLeaf& leaf : places[std::size_t(at)].open)
                if (!leaf.density) leaf.density = std::make_shared<LocalDensity>(*leaf.tree);
            continue;
        }
        if (halve(current_, plane)) todo.push_back(int(complex.cells.size()) - 1);
        else refused_[std::size_t(current_)].push_back(plane);
        todo.push_back(current_);
    }
}

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
            for (const Plane& p : level_planes(*leaf.density, s, complex.tolerance).planes)
                consider(p, s, 0);
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
    constexpr double smallest = 0.5;      // in radii
    constexpr double sharp_smallest = 1e5;  // in tolerances
    if (size[axis] <= (least < infinity ? smallest * least : sharp_smallest * complex.tolerance))
        return false;
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
