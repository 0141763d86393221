// Traversal of a tree of boxes by one ray or by a beam of rays: nearest first, except where boxes overlap.
#if defined(DEBURR_BOX_WALK_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for this set of instructions
#ifdef DEBURR_BOX_WALK_INL
#undef DEBURR_BOX_WALK_INL
#else
#define DEBURR_BOX_WALK_INL
#endif

#include <hwy/highway.h>

#include "raytracer/simd/box_tree.hpp"
#include "raytracer/simd/inline.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using BoxTag = hn::CappedTag<float, BoxNode::width>;
using Sides = hn::Vec<BoxTag>;

const BoxTag box_tag;

DEBURR_INLINE Sides sides(float x) { return hn::Set(box_tag, x); }
DEBURR_INLINE unsigned bits_of_boxes(hn::Mask<BoxTag> m) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(box_tag, m, bytes);
    return bytes[0];
}

// Tells which of a node's boxes a ray meets before `end`, as bits, and at which distances.
class RayMeets {
public:
    explicit DEBURR_INLINE RayMeets(const BoxRay& ray) {
        for (int k = 0; k < 3; ++k) {
            origin_[k] = sides(ray.origin[k]);
            inverse_[k] = sides(ray.inverse[k]);
            near_[k] = ray.inverse[k] < 0 ? BoxNode::width : 0;
        }
    }

    DEBURR_INLINE unsigned operator()(const BoxNode& n, float end, float* t) const {
        unsigned met = 0;
        for (std::size_t i = 0; i < BoxNode::width; i += hn::Lanes(box_tag)) {
            const Sides lo = hn::Max(hn::Max(near(n, 0, i), near(n, 1, i)), hn::Max(near(n, 2, i), hn::Zero(box_tag)));
            const Sides hi = hn::Min(hn::Min(far(n, 0, i), far(n, 1, i)), hn::Min(far(n, 2, i), sides(end)));
            hn::Store(lo, box_tag, t + i);
            met |= bits_of_boxes(lo <= hi) << i;
        }
        return met;
    }

private:
    DEBURR_INLINE Sides near(const BoxNode& n, int k, std::size_t i) const {
        return (hn::Load(box_tag, n.side[k] + near_[k] + i) - origin_[k]) * inverse_[k];
    }
    DEBURR_INLINE Sides far(const BoxNode& n, int k, std::size_t i) const {
        return (hn::Load(box_tag, n.side[k] + (near_[k] ^ BoxNode::width) + i) - origin_[k]) * inverse_[k];
    }

    Sides origin_[3], inverse_[3];
    int near_[3];
};

// Tells which of a node's boxes any ray of a beam may meet, as bits, and the least distances.
class BeamMeets {
public:
    explicit DEBURR_INLINE BeamMeets(const BoxBeam& beam) : beam_(beam) {}

    DEBURR_INLINE unsigned operator()(const BoxNode& n, float end, float* t) const {
        unsigned met = 0;
        for (std::size_t i = 0; i < BoxNode::width; i += hn::Lanes(box_tag)) {
            Sides lo = hn::Zero(box_tag), hi = sides(end);
            for (int k = 0; k < beam_.directed_axes; ++k) {
                const BoxBeam::Directed& d = beam_.directed[k];
                const Sides inverse = sides(d.inverse), other = sides(d.other_inverse);
                const float* const side = n.side[d.axis] + i;
                const Sides near = hn::Load(box_tag, side + (d.down ? BoxNode::width : 0)) - sides(d.to_near);
                const Sides far = hn::Load(box_tag, side + (d.down ? 0 : BoxNode::width)) - sides(d.to_far);
                lo = hn::Max(lo, hn::Min(near * inverse, near * other));
                hi = hn::Min(hi, hn::Max(far * inverse, far * other));
            }
            hn::Store(lo, box_tag, t + i);
            unsigned here = bits_of_boxes(lo <= hi);
            for (int k = 0; k < beam_.undirected_axes; ++k) {
                const BoxBeam::Undirected& u = beam_.undirected[k];
                const float* const side = n.side[u.axis] + i;
                here &= bits_of_boxes(hn::Load(box_tag, side) <= sides(u.hi)) &
                        bits_of_boxes(sides(u.lo) <= hn::Load(box_tag, side + BoxNode::width));
            }
            met |= here << i;
        }
        return met;
    }

private:
    const BoxBeam& beam_;
};

// Prefetches the caller's data of an item.
DEBURR_INLINE void fetch_item(const BoxTree& tree, std::uint32_t i) {
    if (i < tree.first_item) return;
    const char* item = tree.items + (i - tree.first_item) * tree.item_stride;
    for (std::size_t at = 0; at < tree.item_stride; at += 64) __builtin_prefetch(item + at);
}

// Calls the visitor for the items that `meet` (RayMeets or BeamMeets) lets through, up to the distance `end`.
template <class Meet>
DEBURR_INLINE void walk(const BoxTree& tree, float end, const Meet& meet, BoxVisitor visitor) {
    // A child to be visited, and the distance of its box.
    struct Entry {
        std::int32_t child;
        float t;
    };
    Entry stack[(BoxNode::width - 1) * (BoxTree::max_depth + 1)];
    int top = 0;
    std::int32_t now = 0;
    for (;;) {
        if (now >= 0) {
            const BoxNode& n = tree.nodes[now];
            alignas(64) float t[BoxNode::width];
            unsigned met = meet(n, end, t);
            if (met != 0) {
                if ((met & (met - 1)) == 0) {
                    now = n.child[__builtin_ctz(met)];
                    continue;
                }
                const int first = top;
                do {  // insertion sort, nearest on top
                    const int k = __builtin_ctz(met);
                    met &= met - 1;
                    int slot = top++;
                    for (; slot > first && stack[slot - 1].t < t[k]; --slot) stack[slot] = stack[slot - 1];
                    stack[slot] = {n.child[k], t[k]};
                    // The child is visited soon, if not next.
                    if (n.child[k] >= 0)
                        __builtin_prefetch(&tree.nodes[n.child[k]]);
                    else
                        fetch_item(tree, std::uint32_t(~n.child[k]));
                } while (met != 0);
                now = stack[--top].child;
                continue;
            }
        } else {
            end = visitor.visit(visitor.context, std::uint32_t(~now), end);
            if (end < 0) return;
        }
        do {
            if (top == 0) return;
            --top;
        } while (stack[top].t > end);
        now = stack[top].child;
    }
}

void walk_ray(const BoxTree& tree, const BoxRay& ray, BoxVisitor visitor) {
    walk(tree, ray.end, RayMeets(ray), visitor);
}

void walk_beam(const BoxTree& tree, const BoxBeam& beam, BoxVisitor visitor) {
    walk(tree, beam.end, BeamMeets(beam), visitor);
}

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#endif
