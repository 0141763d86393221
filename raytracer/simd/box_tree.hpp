// A tree of boxes, eight to a node, as the kernels go through it (packet_kernels.hpp); bvh.hpp makes it, and says what
// single precision is enough for.
#pragma once
#include <cstddef>
#include <cstdint>

namespace deburr {

struct alignas(64) BoxNode {
    static constexpr int width = 8;

    float side[3][2 * width];   // of each axis the lower, then the upper bounds; an empty slot: lower above upper
    std::int32_t child[width];  // ≥ 0: a node, < 0: ~item
};

struct BoxTree {
    /// A ray's stack has room for trees of so many levels of nodes.
    static constexpr int max_depth = 159;

    const BoxNode* nodes = nullptr;  // the root first
    /// Items from `first_item` on lie at `items`, so many bytes apart: they are fetched before they are visited.
    std::uint32_t first_item = ~0u;
    const char* items = nullptr;
    std::size_t item_stride = 0;
};

/// A ray that goes on to the distance `end`; the inverse of its direction is finite, and not 0.
struct BoxRay {
    float origin[3], inverse[3], end;
};

/// Several rays. Along an axis that all go up, or all down, the extreme origins and inverses; along another the places
/// that any of them reaches.
struct BoxBeam {
    struct Directed {
        int axis;
        bool down;
        float to_near, to_far, inverse, other_inverse;  // from which origin the sides' distances count
    };
    struct Undirected {
        int axis;
        float lo, hi;
    };
    Directed directed[3];
    Undirected undirected[3];
    int directed_axes = 0, undirected_axes = 0;
    float end = 0;  // of the ray that goes farthest
};

/// What is done with every item whose box may be met: visit(context, item, end) returns the distance up to which the
/// ray goes on; a negative one ends the search.
struct BoxVisitor {
    float (*visit)(void* context, std::uint32_t item, float end);
    void* context;
};

}  // namespace deburr
