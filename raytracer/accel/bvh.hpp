// An eight-wide bounding volume hierarchy (BVH): finds which of many boxes a ray may meet, nearest first.
//
// Boxes and rays are kept in single precision, because the tree only has to find every box that the exact ray touches.
// For that, coordinates are measured from the middle of the outermost box in units of half its longest side, the ray is
// started where it enters that box, and every box is enlarged by more than single precision can be off there.
#pragma once
#include <cstdint>
#include <vector>

#include "bounds/vec.hpp"
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

/// The frame in which boxes and rays are measured so that single precision is enough: coordinates inside `around` are
/// in −1 … 1.
struct BoxFrame {
    BoxFrame() = default;
    explicit BoxFrame(const Box& around);

    Vec3 to_local(const Vec3& x) const { return (x - middle) * per_unit; }
    /// The distance `d` in units of this frame, rounded up; 0 if `d` is negative.
    float distance(double d) const { return std::max(0.0f, float(d * per_unit) * (1 + 0x1p-22f)); }

    Vec3 middle{0.0};     // scene coordinates of the frame's origin
    double per_unit = 1;  // frame units per scene length
};

/// An eight-wide BVH over numbered items, each with a finite box.
class Bvh8 {
public:
    /// Builds the binary tree that Bvh8 is made from. A part is a subtree, named by an int that item() or a join
    /// returns; every part but `nothing` has a finite box.
    class Builder {
    public:
        static constexpr int nothing = -1;  // the empty part
        /// Reserves memory for a tree of this many items.
        void reserve(std::size_t items) { parts_.reserve(2 * items); }
        /// Adds an item with the number that visit() is to report; returns its part.
        int item(std::uint32_t number, const Box& box);
        int join(int a, int b);  // the part that holds both; either may be `nothing`
        /// Joins these parts into one by the surface-area heuristic, which keeps the expected number of boxes that a
        /// ray meets small. Returns `nothing` if there are none.
        int join_by_area(std::vector<int> parts);
        const Box& box(int part) const { return parts_[part].box; }

    private:
        friend class Bvh8;
        // A subtree, or a single item.
        struct Part {
            Box box;
            int a, b;  // children; b < 0: an item, whose number is a
        };
        int split(std::vector<int>& order, std::size_t first, std::size_t end, int slot, int depth);
        LargeVector<Part> parts_;
    };

    Bvh8() = default;
    /// The tree under `root` of the builder; empty if that is Builder::nothing. Throws std::length_error if the tree
    /// has more than BoxTree::max_depth levels.
    Bvh8(const Builder& from, int root);

    const Box& box() const { return box_; }
    bool empty() const { return nodes_.empty(); }

    /// Calls visit(i) for every item i whose box the ray may meet in [t0, t1], nearest first except where boxes
    /// overlap. visit() returns the distance up to which the search goes on; a negative one ends it.
    /// Precondition: [t0, t1] is the ray's part in box(), up to rounding; `inverse` is reciprocal(direction).
    template <class Visit>
    void visit(const Vec3& origin, const Vec3& direction, const Vec3& inverse, double t0, double t1, Visit visit) const;

    /// Bounds of several rays: of their points of entry into box(), of their directions, and the longest distance that
    /// any of them goes on from there.
    struct Beam {
        Vec3 min_point, max_point, min_direction, max_direction;
        double longest;
    };
    /// visit() for several rays at once: calls visit(i) for every item i that one of them may meet, nearest first
    /// except where boxes overlap. visit() returns the longest distance that any ray goes on from its point of entry; a
    /// negative one ends the search.
    template <class Visit>
    void visit_packet(const Beam& beam, Visit visit) const;

    /// Tells where the caller keeps the data of the items from `number` on: an array at `first` with this stride in
    /// bytes. It is prefetched before an item is visited, and must stay valid while rays are traced.
    void items_lie_at(std::uint32_t number, const void* first, std::size_t stride) {
        tree_.first_item = number;
        tree_.items = static_cast<const char*>(first);
        tree_.item_stride = stride;
    }

    /// Calls visit(i) for every item i whose box may meet `box`; the boxes are slightly enlarged, so some may not.
    template <class Visit>
    void meeting(const Box& box, Visit visit) const;

private:
    BoxTree tree() const {
        BoxTree tree = tree_;
        tree.nodes = nodes_.data();
        return tree;
    }
    // Adapts the caller's visit(item), which returns a distance in scene units, to BoxVisitor, whose distances count
    // from `start` in units of the frame.
    template <class Visit>
    struct Visitor {
        const BoxFrame& frame;
        double start;
        Visit& visit;

        BoxVisitor of_boxes() { return {call, this}; }
        static float call(void* context, std::uint32_t item, float end) {
            const Visitor& self = *static_cast<const Visitor*>(context);
            const double until = self.visit(item);
            return until < 0 ? -1.0f : until < infinity ? std::min(end, self.frame.distance(until - self.start)) : end;
        }
    };
    static float inverse_of(double x);
    std::int32_t collapse(const Builder& from, int root, int depth);
    BoxNode node_of(const Builder& from, const std::vector<int>& children) const;

    BoxTree tree_;  // without its nodes, which tree() adds
    LargeVector<BoxNode> nodes_;
    Box box_;
    BoxFrame frame_;
};

/// Interval [lo, hi] of a ray within a box, its boundary included; empty if lo > hi.
struct BoxSpan {
    double lo, hi;
};

/// 1/d, but finite where d is 0.
inline double reciprocal(double d) { return std::abs(d) > 1e-300 ? 1 / d : std::copysign(1e300, d); }
inline Vec3 reciprocal(Vec3 d) { return {reciprocal(d.x), reciprocal(d.y), reciprocal(d.z)}; }

/// Interval of the ray within `box`, which must not be empty.
[[gnu::always_inline]] inline BoxSpan span_in(const Box& box, const Vec3& origin, const Vec3& inverse, double t0,
                                              double t1) {
    for (int k = 0; k < 3; ++k) {
        const double a = (box.lo[k] - origin[k]) * inverse[k], b = (box.hi[k] - origin[k]) * inverse[k];
        // Comparisons instead of std::min and std::max on one pair: those become branches, which no processor predicts
        // well.
        const double lo = a < b ? a : b, hi = a > b ? a : b;
        t0 = lo > t0 ? lo : t0;
        t1 = hi < t1 ? hi : t1;
    }
    return {t0, t1};
}

inline float Bvh8::inverse_of(double x) {
    constexpr double most = 1e30;  // with an inverse beyond this the ray does not leave a plane within the tree
    return float(std::clamp(x, -most, most));
}

template <class Visit>
void Bvh8::visit(const Vec3& origin, const Vec3& direction, const Vec3& reciprocals, double t0, double t1,
                 Visit visit) const {
    const Vec3 start = frame_.to_local(origin + direction * t0);
    BoxRay ray;
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = float(start[k]);
        ray.inverse[k] = inverse_of(reciprocals[k]);
    }
    ray.end = frame_.distance(t1 - t0);
    Visitor<Visit> visitor{frame_, t0, visit};
    packet_functions.walk_ray(tree(), ray, visitor.of_boxes());
}

// Along an axis on which all directions have the same sign, the extreme points of entry and directions bound the result
// for every ray, since each operation in single precision is monotone, rounding included. Along any other axis the
// interval of coordinates that any ray reaches is tested instead. The boxes' slack is more than the rounding of these
// intervals.
template <class Visit>
void Bvh8::visit_packet(const Beam& beam, Visit visit) const {
    BoxBeam boxes;
    const Vec3 start = frame_.to_local(beam.min_point), other_start = frame_.to_local(beam.max_point);
    const double length = frame_.distance(beam.longest);
    for (int k = 0; k < 3; ++k) {
        const double least = beam.min_direction[k], most = beam.max_direction[k];
        const float a = float(start[k]), b = float(other_start[k]);
        const bool down = most < 0;
        if (least > 0 || down)
            boxes.directed[boxes.directed_axes++] = {
                k, down, down ? a : b, down ? b : a, inverse_of(reciprocal(most)), inverse_of(reciprocal(least))};
        else
            boxes.undirected[boxes.undirected_axes++] = {k, float(std::max(a + least * length, -2.0)),
                                                         float(std::min(b + most * length, 2.0))};
    }
    boxes.end = frame_.distance(beam.longest);
    Visitor<Visit> visitor{frame_, 0, visit};
    packet_functions.walk_beam(tree(), boxes, visitor.of_boxes());
}

template <class Visit>
void Bvh8::meeting(const Box& box, Visit visit) const {
    if (empty()) return;
    const Vec3 lo = frame_.to_local(box.lo), hi = frame_.to_local(box.hi);
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        const BoxNode& n = nodes_[open.back()];
        open.pop_back();
        for (int i = 0; i < BoxNode::width; ++i) {
            bool meets = true;
            for (int k = 0; k < 3; ++k)
                meets &= double(n.side[k][i]) <= hi[k] && double(n.side[k][i + BoxNode::width]) >= lo[k];
            if (!meets) continue;
            if (n.child[i] < 0)
                visit(std::uint32_t(~n.child[i]));
            else
                open.push_back(n.child[i]);
        }
    }
}

}  // namespace deburr
