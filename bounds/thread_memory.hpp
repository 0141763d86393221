// Memory of a thread for the values of a tree's nodes, used again and again.
#pragma once
#include <cstddef>
#include <vector>

namespace deburr {

/// Memory for `count` values, kept from one call to the next in a thread: what is left of a density has few as a rule.
/// The next call for the same type gets the same memory.
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
