// Finds which parts of shared expressions are the same set up to a placement.
//
// A scene may use one value a thousand times, or call a function that makes an equal value each time; either way it is
// one canonical solid with many placements. Placements are peeled off a solid, and also off a density below its
// rounding where they are rigid, because rounding does not depend on those. Fields are equal only if they are the same
// object.
#pragma once
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "bounds/solid.hpp"

namespace deburr {

/// A use of a canonical solid: its number, the map that places it, and its material.
struct CanonicalPlacement {
    int canonical = -1;
    Affine map;
    int material = -1;  // of parts that have none of their own; −1: none was named
};

/// Numbers canonical solids in the order in which they are first met.
class CanonicalSolids {
public:
    CanonicalSolids() = default;
    CanonicalSolids(const CanonicalSolids&) = delete;  // not copied, because hash functions point into it
    CanonicalSolids& operator=(const CanonicalSolids&) = delete;
    /// The canonical solid that `solid` is a placement of. `solid` must live as long as this object.
    CanonicalPlacement of(const Solid& solid);
    /// The first solid that was this canonical solid, without its placement.
    const Solid& solid(int canonical) const { return solids_[canonical]; }
    /// The number of canonical solids so far.
    std::size_t size() const { return solids_.size(); }

private:
    /// Numbers byte strings 0, 1, 2 … in the order in which they are first met. The strings lie one after the other in
    /// bytes().
    class Numbering {
    public:
        /// The number of the byte string that the caller has appended to bytes() since the last call.
        int number_of_appended();
        std::string& bytes() { return bytes_; }
        std::size_t size() const { return ends_.size(); }

    private:
        std::string_view key(std::size_t i) const {
            const std::size_t first = i ? ends_[i - 1] : 0;
            return std::string_view(bytes_).substr(first, ends_[i] - first);
        }
        struct Hash {
            const Numbering* of;
            std::size_t operator()(int i) const { return std::hash<std::string_view>()(of->key(std::size_t(i))); }
        };
        struct Equal {
            const Numbering* of;
            bool operator()(int a, int b) const { return of->key(std::size_t(a)) == of->key(std::size_t(b)); }
        };
        std::string bytes_;
        std::vector<std::size_t> ends_;
        std::unordered_set<int, Hash, Equal> known_{0, Hash{this}, Equal{this}};
    };

    int base(const Solid& solid);
    int rounded(const SolidNode& node, const Density& density);
    int density(const Density& density);

    std::vector<Solid> solids_;
    Numbering solid_keys_, density_keys_;
    std::unordered_map<const void*, int> known_solids_, known_densities_;
};

/// Calls visit(leaf, placement) for every rounded density and field of the solids, from left to right. enter(node) is
/// asked at each node, and nothing at or below a node is visited where it returns false: a few shared values can stand
/// for more placements than can be counted.
template <class Enter, class Visit>
void for_each_leaf(const std::vector<Solid>& roots, Enter enter, Visit visit) {
    std::vector<std::pair<const Solid*, Affine>> open;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({&*root, {}});
    while (!open.empty()) {
        const auto [solid, map] = open.back();
        open.pop_back();
        const SolidNode& node = solid->node();
        if (!enter(node)) continue;
        if (node.children().empty()) {
            visit(*solid, map);
            continue;
        }
        const Affine inner = node.kind == SolidNode::Kind::transform ? compose(map, node.map()) : map;
        const auto children = node.children();
        for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back({&*child, inner});
    }
}

/// The number of half-spaces (and sizes of fields) that have to be laid out at least: those of a value that unions
/// place several times count once.
double half_spaces_to_lay_out(const std::vector<Solid>& solids);

}  // namespace deburr
