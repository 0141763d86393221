// Sorted lists without duplicates, used as sets.
#pragma once
#include <algorithm>
#include <vector>

namespace deburr {

/// Sorts the items and keeps one of those that are equal.
template <class Item>
void sort_once(std::vector<Item>& items) {
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace deburr
