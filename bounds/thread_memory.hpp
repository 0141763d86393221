// Scratch memory of a thread for the values of a tree's nodes.
#pragma once
#include <cstddef>
#include <vector>

namespace deburr {

/// Memory for `count` values of type T, owned by the calling thread and reused: the next call for the same type returns
/// the same memory, with whatever values the last user left in it. Up to 32 values, as most local densities have, are
/// not on the heap.
template <class T>
T* memory_for(std::size_t count) {
    constexpr std::size_t usual = 32;
    static thread_local constinit T few[usual] = {};
    if (count <= usual) return few;
    static thread_local std::vector<T> many;
    if (many.size() < count) many.resize(count);
    return many.data();
}

}  // namespace deburr
