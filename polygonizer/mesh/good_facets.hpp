// Facets that were found good before, so that what is polygonized again where nothing changed need not be judged again.
#pragma once
#include <cstdint>
#include <vector>

#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// A set of facets by the bits of their corners' positions and normals, and by their leaves: by 128 bits made of these,
/// which no two facets of any mesh are likely to share.
class GoodFacets {
public:
    bool has(const Mesh& mesh, const Triangle& triangle, Origin origin) const {
        return !keys_.empty() && keys_[place(key_of(mesh, triangle, origin))] != nobody;
    }
    /// Forgets what there was, and takes all triangles of the mesh but those, which come in rising order.
    void become(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& but);

private:
    struct Key {
        std::uint64_t a, b;
        bool operator==(const Key&) const = default;
    };
    static constexpr Key nobody{0, 0};

    static Key key_of(const Mesh& mesh, const Triangle& triangle, Origin origin);
    std::size_t place(Key key) const;

    std::vector<Key> keys_;  // a power of two of them, or none
};

}  // namespace deburr
