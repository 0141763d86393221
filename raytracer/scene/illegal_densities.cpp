#include "raytracer/scene/illegal_densities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "bounds/canonical_solids.hpp"
#include "bounds/legality.hpp"

namespace deburr {
namespace {

// Tree nodes that may be evaluated in all, for each box that may be examined for an operator: some 0.2 s with the boxes
// of `render`, and 3 s with those of `info`.
constexpr std::int64_t nodes_a_box = 10'000;

/// The rounded leaves whose densities have sums or differences, each shape once, where it is placed first. Other
/// densities are legal.
class Suspects {
public:
    explicit Suspects(const std::vector<Solid>& solids) {
        std::unordered_set<const SolidNode*> met;
        const auto first_met = [&](const SolidNode& node) { return met.insert(&node).second; };
        for_each_leaf(solids, first_met, [&](const Solid& leaf, const Affine& map) {
            const SolidNode& node = leaf.node();
            if (node.field() || node.convolved() || !node.density().node().may_be_illegal) return;
            const CanonicalPlacement placed = canonical_.of(leaf);
            if (seen_.insert(placed.canonical).second) all_.push_back({placed.canonical, compose(map, placed.map)});
        });
    }

    std::size_t size() const { return all_.size(); }
    DensityTree tree(std::size_t i) const {
        const SolidNode& node = canonical_.solid(all_[i].first).node();
        return flatten(node.density(), node.radius(), all_[i].second);
    }

private:
    CanonicalSolids canonical_;
    std::unordered_set<int> seen_;
    std::vector<std::pair<int, Affine>> all_;
};

}  // namespace

std::vector<std::string> illegal_densities(const Scene& scene, int boxes) {
    std::vector<std::string> lines;
    std::vector<std::pair<int, Op>> reported;
    const Suspects suspects(scene.solids);
    // Limits the total time, however many there are.
    LegalityEffort effort{std::min(boxes, 500 * boxes / std::max(1, int(suspects.size())) + 1), nodes_a_box * boxes};
    for (std::size_t i = 0; i < suspects.size() && effort.nodes > 0; ++i)
        for (const IllegalDensity& d : find_illegal(suspects.tree(i), effort)) {
            const std::pair<int, Op> location{d.line, d.op};
            if (std::find(reported.begin(), reported.end(), location) != reported.end()) continue;
            reported.push_back(location);
            const std::string where = scene.place(d.line);
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
