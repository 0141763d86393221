// Rays through BSPs of one space.
//
// The BSPs' cells say what there is; which of them a ray meets is found by one tree of boxes
// (box_tree.hpp) around what is in them, so that empty cells cost nothing. Only outside of that tree,
// where an unbounded solid goes on, is a BSP itself traversed.
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

/// A BSP, and how the space around calls its solids.
struct NamedBsp {
    BspTree tree;
    std::vector<int> solids;  // by the BSP's numbers
};

/// What is in a space besides: found by its box, asked for by its number.
class Others {
public:
    /// First crossing along the ray in [0, t_max].
    virtual FoundSurface find(std::uint32_t other, const Ray& ray, double t_max, TraceCounters& counters) const = 0;
    /// Whether there is one.
    virtual bool any(std::uint32_t other, const Ray& ray, double t_max, TraceCounters& counters) const = 0;

protected:
    ~Others() = default;
};

class BspTracer {
public:
    BspTracer() = default;
    /// Of one BSP, with its numbers.
    BspTracer(BspTree&& tree, Criterion criterion);
    /// Of several, of which but the first must be bounded, and of others' boxes.
    BspTracer(std::vector<NamedBsp> bsps, const std::vector<Box>& others, Criterion criterion);

    /// First crossing along the ray in [0, t_max]. `others` are asked by the number of their box.
    FoundSurface find(const Ray& ray, double t_max, TraceCounters& counters, const Others* others = nullptr) const;
    /// Whether there is one.
    bool any(const Ray& ray, double t_max, TraceCounters& counters, const Others* others = nullptr) const;

    const std::vector<BspTree>& trees() const { return trees_; }  // without their LocalSolids
    const Pieces& pieces() const { return pieces_; }  // what these were, one tree's after the other's

private:
    template <bool Any>
    class Finder;

    std::vector<BspTree> trees_;
    double scale_ = 1;     // the largest of theirs
    Pieces pieces_;
    Pieces planes_;        // whole solids
    BoxTree boxes_;        // of pieces and then of others; unbounded pieces as far as all else reaches
    bool bounded_ = true;  // nothing is outside of `boxes_`
};

}  // namespace deburr
