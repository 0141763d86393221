// Facets that were found good before, so that what is polygonized again where nothing changed need not be judged again.
#pragma once
#include <cstdint>
#include <vector>

#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// 128 bits made of the bits of a facet's corners' positions and normals, and of its leaf.
struct FacetKey {
    std::uint64_t a = 0, b = 0;
    bool operator==(const FacetKey&) const = default;
    std::size_t hash() const { return std::size_t(a ^ b >> 32); }
};
FacetKey facet_key(const Mesh& mesh, const Triangle& triangle, Origin origin);

/// A set of facets by the bits of their corners' positions and normals, and by their leaves: by 128 bits made of these,
/// which no two facets of any mesh are likely to share.
class GoodFacets {
public:
    bool has(const Mesh& mesh, const Triangle& triangle, Origin origin) const {
        return !keys_.empty() && keys_[place(facet_key(mesh, triangle, origin))] != nobody;
    }
    /// Forgets what there was, and takes all triangles of the mesh but those, which come in rising order.
    void become(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& but);

private:
    static constexpr FacetKey nobody{};

    std::size_t place(FacetKey key) const;

    std::vector<FacetKey> keys_;  // a power of two of them, or none
};

}  // namespace deburr
