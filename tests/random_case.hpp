// Random densities, solids and points. Each is a function of a seed alone.
#pragma once
#include <cstdint>
#include <vector>

#include "bounds/csg_bounds.hpp"
#include "bounds/solid.hpp"

namespace deburr {

/// The seeds 1 … count.
inline std::vector<std::uint64_t> seeds(int count) {
    std::vector<std::uint64_t> all;
    for (int i = 0; i < count; ++i) all.push_back(std::uint64_t(i) + 1);
    return all;
}

/// True if x is within rounding of a plane with no or nearly no rounding, where both sides are acceptable answers.
inline bool on_a_jump(const DensityTree& tree, Vec3 x) {
    for (const HalfSpace& h : tree.half_spaces)
        if (h.radius < 1e-3 && std::abs(h.distance(x)) < h.radius + 1e-9) return true;
    return false;
}

/// Generator of random test cases (splitmix64).
class Gen {
public:
    explicit Gen(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x1234567) { number(); }

    /// A number in [0, 1).
    double number() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    double between(double lo, double hi) { return lo + (hi - lo) * number(); }
    int below(int n) { return int(number() * n); }
    bool chance(double p) { return number() < p; }
    /// A threshold in [0, 1]: in half of the cases 0 or 1.
    double threshold() { return chance(0.25) ? 0.0 : chance(0.33) ? 1.0 : number(); }

    Vec3 point(double reach = 1.5) { return {between(-reach, reach), between(-reach, reach), between(-reach, reach)}; }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = point(1);
            const double length = glm::length(v);
            if (length > 0.1 && length < 1) return v / length;
        }
    }
    /// A unit vector, parallel to an axis in more than half of the cases.
    Vec3 normal() {
        if (chance(0.4)) return direction();
        Vec3 n(0.0);
        n[below(3)] = chance(0.5) ? 1 : -1;
        return n;
    }
    Affine map(bool may_shear = true) {
        Affine m;
        const Vec3 a = direction();
        const Vec3 b = glm::normalize(glm::cross(a, direction()));
        m.linear = Mat3(a, b, glm::cross(a, b));
        if (may_shear && chance(0.5))
            for (int k = 0; k < 3; ++k) m.linear[k] *= between(0.5, 2.0) * (chance(0.2) ? -1 : 1);
        m.shift = point(0.5);
        return m;
    }

    Density box() {
        Vec3 lo, hi;
        for (int k = 0; k < 3; ++k) {
            // Six coordinates of ten are on a grid, so that faces touch and coincide.
            const bool grid = chance(0.6);
            lo[k] = grid ? -1 + 0.25 * below(6) : between(-1, 0.5);
            hi[k] = lo[k] + (grid ? 0.25 * (1 + below(4)) : between(0.1, 1));
        }
        const Density d = Density::box(lo, hi);
        return chance(0.25) ? d.transformed(map()) : d;
    }
    Density part() {
        const Density d = chance(0.3) ? Density::half_space(normal(), between(-0.7, 0.7)) : box();
        return chance(0.15) ? d.radius(chance(0.2) ? 0.0 : between(0.02, 0.5)) : d;
    }
    /// A density of up to 2^depth parts under Boolean operators.
    Density boolean(int depth) {
        if (depth == 0 || chance(0.15)) return part();
        switch (below(4)) {
            case 0: return boolean(depth - 1) & boolean(depth - 1);
            case 1: return ~boolean(depth - 1) | part();
            case 2: return boolean(depth - 1) & ~part();
            default: return boolean(depth - 1) | boolean(depth - 1);
        }
    }
    /// A density under the papers' operators that need not be legal.
    Density arithmetic(int depth) {
        if (depth == 0 || chance(0.15)) return part();
        const Density a = arithmetic(depth - 1), b = chance(0.2) ? boolean(depth - 1) : arithmetic(depth - 1);
        switch (below(3)) {
            case 0: return a + b;
            case 1: return a * b;
            default: return a - b;
        }
    }
    /// A density that is in [0, 1] everywhere by the papers' rules: a product; a product cut by a plane into two parts
    /// that are summed; or a product minus a part of itself.
    Density legal(int depth) {
        if (depth == 0) return part();
        const Density a = legal(depth - 1);
        switch (below(3)) {
            case 0: return a * legal(depth - 1);
            case 1: {  // disjoint parts: ρF + ρ(1 − F)·b, with F of the plane
                const Vec3 n = normal();
                const double d = between(-0.5, 0.5);
                return a * Density::half_space(n, d) + a * Density::half_space(-n, -d) * part();
            }
            default: return a - a * part();
        }
    }
    double radius() {
        switch (below(6)) {
            case 0: return 0;
            case 1: return 1e-7;
            case 2: return between(0.3, 0.6);
            default: return between(0.02, 0.3);
        }
    }
    Solid leaf() {
        const Density d = chance(0.5) ? boolean(below(3)) : chance(0.7) ? legal(below(2)) : arithmetic(below(2));
        const Solid s = Solid::rounded(radius(), d);
        return chance(0.3) ? s.transformed(map()) : s;
    }
    Solid solid(int depth) {
        if (depth == 0 || chance(0.2)) return leaf();
        const Solid a = solid(depth - 1), b = solid(depth - 1);
        const int op = below(3);
        return op == 0 ? a | b : op == 1 ? a & b : a - b;
    }
    /// A point within the filter of one of one to three random planes: likely where the density varies. The tree must
    /// have a half-space.
    Vec3 near(const DensityTree& tree, double reach = 1.2) {
        Vec3 x = point(reach);
        for (int i = below(3); i >= 0; --i) {
            const HalfSpace& h = tree.half_spaces[below(int(tree.half_spaces.size()))];
            x -= h.normal * (h.distance(x) + between(-1, 1) * h.radius);
        }
        return x;
    }
    /// A point on one of the CSG's planes or where two or three of them meet, moved by a few roundings to the outside
    /// or inside.
    Vec3 tight_point(const BoundCsg& csg, bool outside) {
        Vec3 x = point();
        if (csg.planes.empty()) return x;
        const auto plane = [&] { return csg.planes[below(int(csg.planes.size()))]; };
        const int count = below(3);
        for (int pass = 0; pass < 30; ++pass) {
            // Projections onto the planes in turn; few planes that are far from parallel, so this converges.
            if (pass == 0) {
                chosen_.clear();
                for (int i = 0; i <= count; ++i) chosen_.push_back(plane());
            }
            for (const BoundPlane& p : chosen_) x -= p.normal * (glm::dot(p.normal, x) - p.offset);
        }
        for (const BoundPlane& p : chosen_)
            x += p.normal * ((outside ? 2 : -2) * epsilon * (std::abs(p.offset) + 0.25));
        return x;
    }

private:
    std::uint64_t state_;
    std::vector<BoundPlane> chosen_;
};

}  // namespace deburr
