#include "raytracer/scene/illegal_densities.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <unordered_set>

#include "bounds/canonical_solids.hpp"
#include "bounds/legality.hpp"

namespace deburr {
namespace {

/// The rounded leaves whose densities have sums or differences: each form once, where it is first
/// placed. What has none is legal.
class Suspects {
public:
    explicit Suspects(const std::vector<Solid>& solids) {
        for (const Solid& solid : solids)
            for_each_leaf(solid, [&](const Solid& leaf, const Affine& map) {
                const SolidNode& node = leaf.node();
                if (node.field || node.convolved || !seen_.insert(&node).second) return;
                if (has_sum(node.density[0].node())) add(leaf, map);
            });
    }

    std::vector<DensityTree> trees;

private:
    bool has_sum(const DensityNode& root) {
        using Kind = DensityNode::Kind;
        std::vector<const DensityNode*> all{&root};
        std::unordered_set<const void*> met{&root};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const DensityNode& node = *all[i];
            if (node.kind == Kind::sum || node.kind == Kind::difference) return true;
            if (node.kind == Kind::disjunction || node.kind == Kind::conjunction || node.kind == Kind::complement)
                continue;  // all below is read as a Boolean function
            for (const Density& child : node.children)
                if (!without_sum_.count(&child.node()) && met.insert(&child.node()).second)
                    all.push_back(&child.node());
        }
        without_sum_.merge(met);
        return false;
    }

    void add(const Solid& solid, const Affine& map) {
        const PlacedForm placed = forms_.of(solid);
        if (!told_.insert(placed.form).second) return;
        const SolidNode& form = forms_.solid(placed.form).node();
        trees.push_back(flatten(form.density[0], form.radius, compose(map, placed.map)));
    }

    SolidForms forms_;
    std::unordered_set<int> told_;
    std::unordered_set<const void*> seen_, without_sum_;
};

}  // namespace

std::vector<std::string> illegal_densities(const Scene& scene, int boxes) {
    std::vector<std::string> lines;
    std::vector<std::pair<int, Op>> told;
    const Suspects suspects(scene.solids);
    // However many there are, it should not take long.
    const int each = std::min(boxes, 500 * boxes / std::max(1, int(suspects.trees.size())) + 1);
    for (const DensityTree& tree : suspects.trees)
        for (const IllegalDensity& d : find_illegal(tree, each)) {
            const std::pair<int, Op> place{d.line, d.op};
            if (std::find(told.begin(), told.end(), place) != told.end()) continue;
            told.push_back(place);
            const std::string where = d.line > 0 ? fmt::format("{}:{}", scene.file, d.line) : scene.file;
            const bool above = d.value > 1;
            const char* why = d.op == Op::sum ? "its parts overlap: use |"
                              : above         ? "what it subtracts from is illegal"
                                              : "what it subtracts sticks out: clip it, or use & ~";
            lines.push_back(
                fmt::format("{}: {}: expected a density of at {}, got {:.4g} at ({:.4g}, {:.4g}, {:.4g}); {}", where,
                            d.op == Op::sum ? "sum" : "difference", above ? "most 1" : "least 0", d.value, d.point.x,
                            d.point.y, d.point.z, why));
        }
    return lines;
}

}  // namespace deburr
