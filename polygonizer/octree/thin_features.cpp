#include "polygonizer/octree/thin_features.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"

namespace deburr {
namespace {

// The least thickness of a sheet that is searched for, in cells: thinner ones taper to an edge or a contact.
constexpr double thinnest = 0.25;

// A leaf with a part of the surface for which it has no point because the part is too thin.
struct Unseen {
    int leaf;
    double thickness;
};

class ThinSearch {
public:
    ThinSearch(CellTree& tree, const Linking& linking, const PointMesh& mesh)
        : tree_(tree), linking_(linking), mesh_(mesh) {}

    bool split_unseen() {
        std::vector<Unseen> unseen;
        for (std::size_t i = 0; i < linking_.loops.size(); ++i)
            if (!mesh_.points[i].hard()) probe_across(linking_.loops[i].leaf, mesh_.points[i], unseen);
        for (int i = 0; i < int(tree_.cells().size()); ++i) {
            const OctreeCell& c = tree_.cell(i);
            if (c.children < 0 && c.open) probe_inside(i, unseen);
        }
        bool changed = false;
        for (const Unseen& u : unseen) {
            // Cells of twice a sheet's thickness may see it; if not, the next round halves them.
            const double half = 0.5 * tree_.unit() * tree_.cell(u.leaf).size;
            if (tree_.cell(u.leaf).children < 0) changed |= split_to(u.leaf, std::min(half, 2 * u.thickness));
        }
        return changed;
    }

private:
    // The first loop of a leaf; end() if it has none.
    std::vector<Loop>::const_iterator first_loop(int leaf) const {
        const auto before = [](const Loop& l, int wanted) { return l.leaf < wanted; };
        const auto loop = std::lower_bound(linking_.loops.begin(), linking_.loops.end(), leaf, before);
        return loop != linking_.loops.end() && loop->leaf == leaf ? loop : linking_.loops.end();
    }

    // Whether a point of the mesh in this leaf, at most `far` of its sides from x, faces as the surface does at x.
    bool sees(int leaf, Vec3 x, Vec3 normal, double far) const {
        constexpr double alike_enough = 0.5;  // a cosine
        for (auto loop = first_loop(leaf); loop != linking_.loops.end() && loop->leaf == leaf; ++loop) {
            const SurfacePoint& p = mesh_.points[loop - linking_.loops.begin()];
            if (glm::length(p.position - x) > far * tree_.unit() * tree_.cell(leaf).size) continue;
            if (p.hard()) return true;
            if (glm::dot(p.faces[0].normal, normal) > alike_enough) return true;
        }
        return false;
    }

    /// Splits a leaf, recursively, to cells no longer than `side`; false if nothing changed.
    bool split_to(int leaf, double side) {
        const OctreeCell c = tree_.cell(leaf);
        if (c.children < 0 && (!c.open || tree_.unit() * c.size <= side || !tree_.split(leaf))) return false;
        bool changed = c.children < 0;
        for (int k = 0; k < 8; ++k) changed |= split_to(tree_.cell(leaf).children + k, side);
        return changed;
    }

    // Probes from a point through the solid, and across a gap, to the next surface.
    void probe_across(int leaf, const SurfacePoint& p, std::vector<Unseen>& unseen) const {
        const double side = tree_.unit() * tree_.cell(leaf).size;
        const SignedDistance& solid = tree_.solid(tree_.cell(leaf));
        for (const double step : {-1.0, 1.0}) {
            const Vec3 line = p.faces[0].normal * step;
            const bool in = step < 0;
            for (const double far : {0.5 * side, side}) {
                const Vec3 beyond = p.position + line * far;
                if (solid.inside(beyond) == in) continue;
                double near = 0.5 * far;
                while (near > thinnest * tree_.edge() && solid.inside(p.position + line * near) != in) near *= 0.5;
                const Vec3 before = p.position + line * near;
                if (solid.inside(before) != in) break;  // thinner than any cell
                const Vec3 x = in ? surface_root(solid, before, beyond) : surface_root(solid, beyond, before);
                const int there = tree_.find(x);
                if (!tree_.cell(there).open || sees(there, x, solid.at(x).normal, 2)) break;
                const double thickness = glm::length(x - p.position);
                if (thickness < thinnest * tree_.edge()) break;
                unseen.push_back({there, thickness});
                unseen.push_back({leaf, thickness});
                break;
            }
        }
    }

    // Probes from the middle of a leaf whose corners show no surface to the surface. Parts that reach into the leaf
    // from a neighbour are found there.
    void probe_inside(int leaf, std::vector<Unseen>& unseen) const {
        const OctreeCell& c = tree_.cell(leaf);
        if (first_loop(leaf) != linking_.loops.end()) return;
        const SignedDistance& solid = tree_.solid(c);
        const Box box = tree_.box(c);
        const double side = box.hi.x - box.lo.x;
        constexpr int max_steps = 8;
        constexpr double near_enough = 1e-3, deep = 0.3;  // in sides
        Vec3 x = 0.5 * (box.lo + box.hi);
        const bool outside = !solid.inside(x);
        for (int step = 0; step < max_steps; ++step) {
            const SurfaceSample o = solid.at(x);
            if (!std::isfinite(o.distance) || o.normal == Vec3(0.0)) return;
            x += o.normal * o.distance;
            if (!inflated(box, 0.5 * side).contains(x)) return;
            if (std::abs(o.distance) > near_enough * side) continue;
            if (!box.contains(x)) return;
            for (int axis = 0; axis < 3; ++axis)
                for (const double move : {-side, side}) {
                    Vec3 beside = x;
                    beside[axis] += move;
                    const double depth = move < 0 ? x[axis] - box.lo[axis] : box.hi[axis] - x[axis];
                    if (depth < deep * side && sees(tree_.find(beside), x, o.normal, 1)) return;
                }
            double thickness = 0.5 * side;
            const Vec3 onward = o.normal * (outside ? -1.0 : 1.0);
            const double least = linking_.loops.empty() ? 0.5 * tree_.unit() : thinnest * tree_.edge();
            while (thickness >= least && solid.inside(x + onward * thickness) != outside) thickness *= 0.5;
            if (thickness >= least || linking_.loops.empty()) unseen.push_back({leaf, thickness});
            return;
        }
    }

    CellTree& tree_;
    const Linking& linking_;
    const PointMesh& mesh_;
};

}  // namespace

bool split_unseen(CellTree& tree, const Linking& linking, const PointMesh& mesh) {
    return ThinSearch(tree, linking, mesh).split_unseen();
}

}  // namespace deburr
