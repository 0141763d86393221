// Rays through one BSP.
//
// The BSP's cells say what there is; which of them a ray meets is found by a tree of boxes
// (box_tree.hpp) around what is in them, so that empty cells cost nothing. Only outside of that tree,
// where an unbounded solid goes on, is the BSP itself traversed.
#pragma once
#include "raytracer/box_tree.hpp"
#include "raytracer/bsp_tree.hpp"
#include "raytracer/piece.hpp"
#include "raytracer/ray_tracer.hpp"

namespace deburr {

struct FoundSurface {
    SurfaceCrossing crossing;  // t = infinity: none
    int solid = -1;            // as the BSP numbers them
    double error = 0;          // of the position: what floating point rounds it by
};

class BspTracer {
public:
    BspTracer() = default;
    BspTracer(BspTree&& tree, Criterion criterion);

    /// First crossing along the ray in [0, t_max]; with `any`, of some solid, and only that there is
    /// one counts.
    FoundSurface find(const Ray& ray, double t_max, bool any, TraceCounters& counters) const;

    const BspTree& tree() const { return tree_; }  // without its LocalSolids
    const Pieces& pieces() const { return pieces_; }  // number by number, what these were

private:
    class Finder;
    double rounding(const Ray& ray, double t) const;

    BspTree tree_;
    Pieces pieces_;
    Pieces planes_;        // whole solids
    BoxTree boxes_;        // of pieces; unbounded ones as far as the bounded reach
    bool bounded_ = true;  // nothing is outside of `boxes_`
};

}  // namespace deburr
