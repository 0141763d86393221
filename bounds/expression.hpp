// Helpers for the shared expressions of densities and of solids. Scenes write chains as long as their loops, so nothing
// here recurses.
#pragma once
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace deburr {

/// Destroys `children` without recursion: a node that loses its last owner while another is being
/// destroyed is put on a list, whose nodes are destroyed one by one.
template <class Handle>
void release(std::span<Handle> children) {
    thread_local std::vector<Handle>* dying = nullptr;
    if (children.empty()) return;
    if (dying) {
        for (Handle& child : children) dying->push_back(std::move(child));
        return;
    }
    std::vector<Handle> list(std::move_iterator(children.begin()), std::move_iterator(children.end()));
    dying = &list;
    while (!list.empty()) {
        const Handle last = std::move(list.back());
        list.pop_back();
    }
    dying = nullptr;
}

/// Replaces done[first …] by a single node: neighbours are paired by add(a, b), level by level, until one node is left.
/// So a chain becomes a balanced tree.
template <class Add>
void combine_balanced(std::vector<int>& done, std::size_t first, Add add) {
    while (done.size() - first > 1) {
        std::size_t to = first;
        for (std::size_t from = first; from < done.size(); from += 2)
            done[to++] = from + 1 < done.size() ? add(done[from], done[from + 1]) : done[from];
        done.resize(to);
    }
}

}  // namespace deburr
