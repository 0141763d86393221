// A set of facets that were found good, so that facets that come again where nothing changed need not be judged again.
#pragma once
#include <cstdint>
#include <vector>

#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// A 128-bit hash of the bits of a facet's corner positions and normals and of its leaf.
struct FacetKey {
    std::uint64_t a = 0, b = 0;
    bool operator==(const FacetKey&) const = default;
    std::size_t hash() const { return std::size_t(a ^ b >> 32); }
};
FacetKey facet_key(const Mesh& mesh, const Triangle& triangle, Origin origin);

/// A set of facets by their 128-bit keys, which two different facets of a mesh are not likely to share.
class GoodFacets {
public:
    bool has(const Mesh& mesh, const Triangle& triangle, Origin origin) const {
        return !keys_.empty() && keys_[place(facet_key(mesh, triangle, origin))] != nobody;
    }
    /// Replaces the set by all triangles of the mesh except those in `but`, which is in increasing order.
    void become(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& but);

private:
    /// Marks an empty slot.
    static constexpr FacetKey nobody{};

    std::size_t place(FacetKey key) const;

    std::vector<FacetKey> keys_;  // open-addressing hash table; its size is a power of two, or 0
};

}  // namespace deburr
