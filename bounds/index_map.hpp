// A map from a few integers to indices that one thread fills and empties again and again.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace deburr {

/// A hash table with open addressing. It allocates memory only when it has to hold more entries than ever before.
class IndexMap {
public:
    IndexMap() { reset(0); }
    /// Empties the map and makes room for `most` entries; inserting more is an error.
    void reset(std::size_t most) {
        const int bits = std::bit_width(2 * most + 1);
        shift_ = 32 - bits;
        mask_ = (std::size_t(1) << bits) - 1;
        keys_.assign(mask_ + 1, none);
        values_.resize(keys_.size());
    }
    /// The index of `key` ≥ 0, or −1 if it has none.
    int find(int key) const {
        const std::size_t at = place(key);
        return keys_[at] == key ? values_[at] : -1;
    }
    /// The index of `key` ≥ 0, which becomes `otherwise` if it had none.
    int find_or_insert(int key, int otherwise) {
        const std::size_t at = place(key);
        if (keys_[at] == key) return values_[at];
        keys_[at] = key;
        return values_[at] = otherwise;
    }

private:
    static constexpr int none = -1;

    // Where the key is, or else where it would be inserted.
    std::size_t place(int key) const {
        std::size_t at = (std::uint32_t(key) * 0x9E3779B9u) >> shift_;
        while (keys_[at] != none && keys_[at] != key) at = (at + 1) & mask_;
        return at;
    }

    std::vector<int> keys_, values_;
    std::size_t mask_ = 0;
    int shift_ = 0;
};

}  // namespace deburr
