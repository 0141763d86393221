#include "polygonizer/mesh/good_facets.hpp"

#include <algorithm>
#include <bit>

namespace deburr {

FacetKey facet_key(const Mesh& mesh, const Triangle& triangle, Origin origin) {
    // Odd numbers without a pattern: fractions of the golden ratio, √2 and √3.
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15, root2 = 0x6a09e667f3bcc909, root3 = 0xbb67ae8584caa73b;
    FacetKey key{golden, root2 ^ std::uint64_t(std::uint32_t(origin.leaf))};
    const auto add = [&](double x) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        key.a = std::rotl((key.a ^ bits) * golden, 29);
        key.b = std::rotl((key.b + bits) * root3, 31);
    };
    for (std::size_t k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) {
            add(mesh.positions[triangle.vertex[k]][axis]);
            add(mesh.normals[triangle.normal[k]][axis]);
        }
    return key;
}

// The slot of the key, or the empty one where it belongs.
std::size_t GoodFacets::place(FacetKey key) const {
    std::size_t at = key.hash() & (keys_.size() - 1);
    while (keys_[at] != nobody && keys_[at] != key) at = (at + 1) & (keys_.size() - 1);
    return at;
}

void GoodFacets::become(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& but) {
    keys_.assign(std::bit_ceil(2 * origins.size() + 1), nobody);
    auto next = but.begin();
    for (std::size_t t = 0; t < origins.size(); ++t) {
        if (next != but.end() && *next == int(t)) {
            ++next;
            continue;
        }
        const FacetKey key = facet_key(mesh, mesh.triangles[t], origins[t]);
        keys_[place(key)] = key;
    }
}

}  // namespace deburr
