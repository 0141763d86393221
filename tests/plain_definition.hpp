// Reference evaluation of densities, fields, solids and rays straight from their definitions. Tests hold the faster
// code against it. It evaluates densities node by node, sums Boolean densities over all outcomes and finds crossings of
// rays by dense sampling. It shares nothing with the code under test except the flat trees and the stored forms.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "bounds/free_form.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr::plain {

/// Profile of a half-space at α = distance/radius [Lobb eq. 2].
inline double profile(double alpha) {
    if (alpha >= 1) return 0;
    if (alpha <= -1) return 1;
    return (1 - alpha) * (1 - alpha) * (2 + alpha) / 4;
}

inline double half_space(const HalfSpace& h, Vec3 x) {
    const double d = glm::dot(h.normal, x) - h.offset;
    if (h.radius == 0) return d <= 0 ? 1 : 0;
    return profile(d / h.radius);
}

inline bool is_boolean(const DensityTree& tree, int i) {
    const TreeNode& n = tree.nodes[i];
    if (n.op == Op::half_space || n.op == Op::conjunction || n.op == Op::disjunction) return true;
    if (n.op == Op::constant) return n.value == 0 || n.value == 1;
    return n.op == Op::complement && is_boolean(tree, n.a);
}

/// Value of the Boolean function at node i; `is_true` has an entry for each half-space of the tree.
inline bool boolean_value(const DensityTree& tree, int i, const std::vector<char>& is_true) {
    const TreeNode& n = tree.nodes[i];
    switch (n.op) {
        case Op::half_space: return is_true[n.a];
        case Op::complement: return !boolean_value(tree, n.a, is_true);
        case Op::conjunction: return boolean_value(tree, n.a, is_true) && boolean_value(tree, n.b, is_true);
        case Op::disjunction: return boolean_value(tree, n.a, is_true) || boolean_value(tree, n.b, is_true);
        default: return n.value > 0.5;
    }
}

inline void half_spaces_below(const DensityTree& tree, int i, std::vector<int>& found) {
    const TreeNode& n = tree.nodes[i];
    if (n.op == Op::half_space)
        found.push_back(n.a);
    else if (n.op != Op::constant) {
        half_spaces_below(tree, n.a, found);
        if (n.b >= 0) half_spaces_below(tree, n.b, found);
    }
}

/// Boolean density at x: the probability that the function at node `root` is true. Families of parallel planes of one
/// radius are drawn one after another; each outcome of a family is a gap between neighbouring thresholds.
inline double boolean(const DensityTree& tree, int root, Vec3 x) {
    std::vector<int> open;
    half_spaces_below(tree, root, open);
    std::vector<char> is_true(tree.half_spaces.size(), false);
    std::vector<int> varying;
    for (const int i : open) {
        const double rho = half_space(tree.half_spaces[i], x);
        is_true[i] = rho == 1;
        if (rho > 0 && rho < 1) varying.push_back(i);
    }
    const auto sum = [&](auto&& self, std::vector<int> rest) -> double {
        if (rest.empty()) return boolean_value(tree, root, is_true);
        const HalfSpace& lead = tree.half_spaces[rest[0]];
        std::vector<int> others;
        struct Member {
            double tau, F;
            int index;
            bool above;
        };
        std::vector<Member> family;
        for (const int i : rest) {
            const HalfSpace& h = tree.half_spaces[i];
            const double along = glm::dot(h.normal, lead.normal);
            const Vec3 n = along < 0 ? -h.normal : h.normal;
            if (glm::length(n - lead.normal) < 1e-9 && std::abs(h.radius - lead.radius) <= 1e-9 * lead.radius) {
                const double tau = along < 0 ? -h.offset : h.offset, rho = half_space(h, x);
                family.push_back({tau, along < 0 ? 1 - rho : rho, i, along < 0});
            } else {
                others.push_back(i);
            }
        }
        std::stable_sort(family.begin(), family.end(), [](const Member& a, const Member& b) { return a.tau < b.tau; });
        double total = 0, below = 0;
        for (std::size_t gap = 0; gap <= family.size(); ++gap) {  // the draw falls just below family[gap].tau
            const double F = gap < family.size() ? family[gap].F : 1;
            const double p = F - below;
            below = std::max(below, F);
            if (!(p > 0)) continue;
            for (std::size_t j = 0; j < family.size(); ++j)
                is_true[family[j].index] = family[j].above ? j < gap : j >= gap;
            total += p * self(self, others);
        }
        return total;
    };
    return sum(sum, varying);
}

inline double density(const DensityTree& tree, int i, Vec3 x) {
    if (is_boolean(tree, i)) return boolean(tree, i, x);
    const TreeNode& n = tree.nodes[i];
    switch (n.op) {
        case Op::sum: return density(tree, n.a, x) + density(tree, n.b, x);
        case Op::product: return density(tree, n.a, x) * density(tree, n.b, x);
        case Op::difference: return density(tree, n.a, x) - density(tree, n.b, x);
        case Op::complement: return 1 - density(tree, n.a, x);
        default: return n.value;
    }
}
inline double density(const DensityTree& tree, Vec3 x) { return density(tree, tree.root(), x); }

/// Value of q at x [Vyatkin eq. 1].
inline long double quadric(const Quadric& q, Vec3 x) {
    const long double y[3] = {(long double)x.x - q.center.x, (long double)x.y - q.center.y,
                              (long double)x.z - q.center.z};
    long double sum = q.k;
    for (int i = 0; i < 3; ++i) {
        sum += q.b[i] * y[i];
        for (int j = 0; j < 3; ++j) sum += y[i] * q.A[i][j] * y[j];
    }
    return sum;
}

/// Value of f at x [Vyatkin eq. 2 and 3]. A field of another kind than FreeForm has no plainer definition than its own
/// at().
inline double field(const Field& f, Vec3 x) {
    const auto* form = dynamic_cast<const FreeForm*>(&f);
    if (!form) return f.at(x).value;
    long double sum = quadric(form->base(), x);
    for (const Perturbation& p : form->perturbations()) {
        const long double q = quadric(p.quadric, x);
        if (q >= 0) sum += p.factor * q * q * q;
    }
    return double(sum);
}

inline bool contains(const SolidTree& tree, int i, Vec3 x) {
    const SolidTreeNode& n = tree.nodes[i];
    switch (n.op) {
        case SolidOp::nothing: return false;
        case SolidOp::everything: return true;
        case SolidOp::leaf: {
            const SolidLeaf& leaf = tree.leaves[n.a];
            return leaf.field ? field(*leaf.field, x) > 0 : density(leaf.density, x) > 0.5;
        }
        case SolidOp::unite: return contains(tree, n.a, x) || contains(tree, n.b, x);
        case SolidOp::intersect: return contains(tree, n.a, x) && contains(tree, n.b, x);
        case SolidOp::subtract: return contains(tree, n.a, x) && !contains(tree, n.b, x);
    }
    return false;
}
inline bool contains(const SolidTree& tree, Vec3 x) { return contains(tree, tree.root(), x); }

/// First t in (0, t_max) where the ray o + t·d changes sides of the solid; infinity if no change is seen. The ray is
/// cut where a half-space begins or ceases to vary and where it meets the planes of a field's box; `steps` points of
/// each segment between cuts are sampled, and bisection refines the first change.
inline double first_crossing(const SolidTree& tree, Vec3 o, Vec3 d, double t_max, int steps) {
    std::vector<double> cuts{0, t_max};
    for (const SolidLeaf& leaf : tree.leaves) {
        if (leaf.field) {
            const Box box = leaf.field->bounding_box();
            for (int k = 0; k < 3; ++k)
                for (const double side : {box.lo[k], box.hi[k]}) {
                    const double t = (side - o[k]) / d[k];
                    if (t > 0 && t < t_max) cuts.push_back(t);
                }
        }
        for (const HalfSpace& h : leaf.density.half_spaces) {
            const double rate = glm::dot(h.normal, d), at = glm::dot(h.normal, o) - h.offset;
            for (const double level : {-h.radius, 0.0, h.radius}) {
                const double t = (level - at) / rate;
                if (t > 0 && t < t_max) cuts.push_back(t);
            }
        }
    }
    std::sort(cuts.begin(), cuts.end());
    const bool start = contains(tree, o);
    double last = 0;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        const double a = cuts[k], b = cuts[k + 1];
        if (b - a < 1e-13 * (1 + b)) continue;
        for (int s = 0; s < steps; ++s) {
            const double t = a + (b - a) * (s + 0.5) / steps;
            if (contains(tree, o + d * t) != start) {
                double lo = last, hi = t;
                for (int i = 0; i < 60; ++i) {
                    const double m = 0.5 * (lo + hi);
                    (contains(tree, o + d * m) != start ? hi : lo) = m;
                }
                return hi;
            }
            last = t;
        }
    }
    return infinity;
}

}  // namespace deburr::plain
