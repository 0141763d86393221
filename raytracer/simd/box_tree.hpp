// The eight-wide tree of boxes as the kernels traverse it (packet_kernels.hpp). accel/bvh.hpp builds it, and says why
// single precision is enough.
#pragma once
#include <cstddef>
#include <cstdint>

namespace deburr {

/// Eight boxes and their children.
struct alignas(64) BoxNode {
    static constexpr int width = 8;

    float side[3][2 * width];   // per axis the lower, then the upper bounds; of an empty slot lower > upper
    std::int32_t child[width];  // ≥ 0: index of a node; < 0: ~number of an item
};

/// A view of a tree, whose memory belongs to the caller.
struct BoxTree {
    /// The stack of a traversal holds trees with this many levels of nodes.
    static constexpr int max_depth = 159;

    const BoxNode* nodes = nullptr;  // the root first
    /// Data of the items from `first_item` on, `item_stride` bytes apart, which is prefetched before the item is
    /// visited.
    std::uint32_t first_item = ~0u;
    const char* items = nullptr;
    std::size_t item_stride = 0;
};

/// A ray in the tree's frame, up to the distance `end`; the inverse of its direction is finite and not 0.
struct BoxRay {
    float origin[3], inverse[3], end;
};

/// Bounds of several rays. On an axis where all directions have the same sign (directed), extreme origins and inverses;
/// on any other, the interval of coordinates that any ray reaches.
struct BoxBeam {
    /// An axis on which all directions have the same sign.
    struct Directed {
        int axis;
        bool down;
        float to_near, to_far, inverse,
            other_inverse;  // extreme origins for near and far sides; extreme inverses
    };
    /// Any other axis.
    struct Undirected {
        int axis;
        float lo, hi;
    };
    Directed directed[3];
    Undirected undirected[3];
    int directed_axes = 0, undirected_axes = 0;
    float end = 0;  // the longest distance that any ray goes
};

/// The callback for items whose box may be met. visit(context, item, end) returns the distance up to which the search
/// goes on; a negative one ends it.
struct BoxVisitor {
    float (*visit)(void* context, std::uint32_t item, float end);
    void* context;
};

}  // namespace deburr
