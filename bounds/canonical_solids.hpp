// Which parts of shared expressions are equal in form: the same set in a space of its own, placed.
//
// A scene may use one value a thousand times, or call a function that makes an equal one each time;
// either way it is one form with many placements. Placements are peeled off, also those of a density
// below its rounding where they are rigid, for rounding does not see these. Fields are equal if they are
// one value.
#pragma once
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "bounds/solid.hpp"

namespace deburr {

/// A form, in the space that it is placed into.
struct CanonicalPlacement {
    int canonical = -1;
    Affine map;
    int material = -1;  // of what has none in the form; −1: none was named
};

class CanonicalSolids {
public:
    CanonicalSolids() = default;
    CanonicalSolids(const CanonicalSolids&) = delete;  // hashes look into it
    CanonicalSolids& operator=(const CanonicalSolids&) = delete;
    /// The solid must live as long as this does.
    CanonicalPlacement of(const Solid& solid);
    /// The first solid that had this form.
    const Solid& solid(int canonical) const { return solids_[canonical]; }
    std::size_t size() const { return solids_.size(); }

private:
    /// Numbers keys 0, 1, 2 … in the order in which they are first met. The keys' bytes lie one after the other.
    class Numbering {
    public:
        /// The number of the key that the caller appended to bytes() since the last call.
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

/// Calls visit(leaf, placement) for the rounded densities and fields of the solids, from left to right. Nothing at
/// or below a node is visited where enter(node) is false: a few shared values can stand for more placements than
/// can be counted.
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

/// Half-spaces (and sizes of fields) that have to be laid out at least: those of one value count once, however often
/// unions place it.
double half_spaces_to_lay_out(const std::vector<Solid>& solids);

}  // namespace deburr
