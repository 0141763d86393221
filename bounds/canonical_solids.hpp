// Which parts of shared expressions are equal in form: the same set in a space of its own, placed.
//
// A scene may use one value a thousand times, or call a function that makes an equal one each time;
// either way it is one form with many placements. Placements are peeled off, also those of a density
// below its rounding where they are rigid, for rounding does not see these. Fields are equal if they are
// one value.
#pragma once
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bounds/solid.hpp"

namespace deburr {

/// A form, in the space that it is placed into.
struct PlacedForm {
    int form = -1;
    Affine map;
    int material = -1;  // of what has none in the form; −1: none was named
};

class SolidForms {
public:
    /// The solid must live as long as this does.
    PlacedForm of(const Solid& solid);
    /// The first solid that had this form.
    const Solid& solid(int form) const { return solids_[std::size_t(form)]; }
    std::size_t size() const { return solids_.size(); }

private:
    int base(const Solid& solid);
    int rounded(const SolidNode& node, const Density& density);
    int density(const Density& density);
    int number(std::unordered_map<std::string, int>& all, const std::string& key, bool& fresh);

    std::vector<Solid> solids_;
    std::unordered_map<std::string, int> solid_keys_, density_keys_;
    std::unordered_map<const void*, int> known_solids_, known_densities_;
};

/// Calls visit(leaf, placement) for every rounded density and field of the solid, from left to right.
template <class Visit>
void for_each_leaf(const Solid& root, Visit visit) {
    std::vector<std::pair<const Solid*, Affine>> open{{&root, {}}};
    while (!open.empty()) {
        const auto [solid, map] = open.back();
        open.pop_back();
        const SolidNode& node = solid->node();
        if (node.children.empty()) {
            visit(*solid, map);
            continue;
        }
        const Affine inner = node.kind == SolidNode::Kind::transform ? compose(map, node.map) : map;
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            open.push_back({&*child, inner});
    }
}

}  // namespace deburr
