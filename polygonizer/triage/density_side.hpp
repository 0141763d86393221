// Ranges of ρ over a region, and the side of the surface on which they put it: by half-space, by density, and for the
// solid that these make up.
#pragma once
#include <vector>

#include "bounds/profile.hpp"
#include "bounds/solid_range.hpp"

namespace deburr {

// ρ ranges that end this near to ½ count as ending there: their ends come from α = 0 up to a few ε.
inline constexpr double level_slack = 1e-12;

/// Where a region lies with respect to the set ρ > ½, with the slack.
inline Side classify_with_slack(Range rho) {
    if (rho.hi <= 0.5 + level_slack) return Side::outside;
    if (rho.lo >= 0.5 - level_slack) return Side::inside;
    return Side::straddling;
}

inline bool is_classified_with_slack(Range rho) { return classify_with_slack(rho) != Side::straddling; }

// The distance from a plane; one within `tolerance` of h or h ± r is that exactly, because a vertex was snapped to it.
inline double snapped(double distance, double radius, double tolerance) {
    for (const double plane : {-radius, 0.0, radius})
        if (std::abs(distance - plane) <= tolerance) return plane;
    return distance;
}

// Range of the half-space's density between two distances; the least is at the greater distance. A sharp half-space is
// constant on either closed side of its plane.
inline double min_rho(const HalfSpace& h, double hi, double tolerance) {
    hi = snapped(hi, h.radius, tolerance);
    return h.radius > 0 ? profile(hi / h.radius) : hi > 0 ? 0.0 : 1.0;
}
inline double max_rho(const HalfSpace& h, double lo, double tolerance) {
    lo = snapped(lo, h.radius, tolerance);
    return h.radius > 0 ? profile(lo / h.radius) : lo >= 0 ? 0.0 : 1.0;
}
inline Range rho_between(const HalfSpace& h, double lo, double hi, double tolerance) {
    return {min_rho(h, hi, tolerance), max_rho(h, lo, tolerance)};
}

/// Whether the half-space's density varies over a region with this range.
inline bool varies(Range rho) { return rho.hi != 0 && rho.lo != 1; }

// Folds away the leaves and operators that are decided, and returns the side of the solid. `solid` has children before
// parents and the root last; it becomes empty if the root is decided.
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
            default: sides.push_back(combine(n.op, sides[n.a], sides[n.b]));
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
        needed[solid[i].a] = needed[solid[i].b] = true;
    }
    std::vector<int> new_index(solid.size(), -1);
    std::vector<SolidTreeNode> to;
    for (std::size_t i = 0; i < solid.size(); ++i) {
        if (!needed[i]) continue;
        SolidTreeNode n = solid[i];
        if (sides[i] != Side::straddling) {
            n = {sides[i] == Side::inside ? SolidOp::everything : SolidOp::nothing};
        } else if (n.op != SolidOp::leaf) {
            const bool a_open = sides[n.a] == Side::straddling;
            const bool b_open = sides[n.b] == Side::straddling;
            if (!b_open || (!a_open && n.op != SolidOp::subtract)) {
                new_index[i] = new_index[b_open ? n.b : n.a];
                continue;
            }
            n.a = new_index[n.a];
            n.b = new_index[n.b];
        }
        new_index[i] = int(to.size());
        to.push_back(n);
    }
    to.resize(std::size_t(new_index.back()) + 1);
    solid = std::move(to);
    return root;
}

}  // namespace deburr
