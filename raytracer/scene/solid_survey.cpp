#include "raytracer/scene/solid_survey.hpp"

#include <vector>

#include "bounds/bounding_box.hpp"
#include "bounds/free_form.hpp"

namespace deburr {
namespace {

SolidFacts facts_of(const SolidTree& tree) {
    SolidFacts facts;
    facts.box = bounding_box(tree);
    for (const SolidLeaf& leaf : tree.leaves) {
        const auto* form = dynamic_cast<const FreeForm*>(leaf.field.get());
        if (form) facts.quadrics += 1.0 + double(form->perturbations().size());
        facts.half_spaces += double(leaf.density.half_spaces.size());
    }
    return facts;
}

SolidFacts placed(const Affine& map, const SolidFacts& facts) {
    SolidFacts result = facts;
    if (!facts.box.empty()) result.box = facts.box.finite() ? image(map, facts.box) : Box::everything();
    return result;
}

}  // namespace

SolidFacts SolidSurvey::at(const Solid& solid) {
    if (solid.node().leaves <= max_half_spaces) return facts_of(flatten(solid));
    const CanonicalPlacement placement = canonical_.of(solid);
    return placed(placement.map, of_canonical(placement.canonical));
}

// With a stack of its own, for unions may be long chains.
const SolidFacts& SolidSurvey::of_canonical(int root) {
    std::vector<int> open{root};
    while (!open.empty()) {
        const int canonical = open.back();
        const Solid solid = canonical_.solid(canonical);
        if (known_.count(canonical)) {
            open.pop_back();
        } else if (solid.node().kind != SolidNode::Kind::unite) {
            known_[canonical] = at(solid);
        } else {
            SolidFacts all;
            const std::size_t before = open.size();
            for (const Solid& child : solid.node().children()) {
                const CanonicalPlacement part = canonical_.of(child);
                const auto at = known_.find(part.canonical);
                if (at == known_.end()) {
                    open.push_back(part.canonical);
                    continue;
                }
                const SolidFacts facts = placed(part.map, at->second);
                if (!facts.box.empty()) all.box = hull(all.box, facts.box);
                all.half_spaces += facts.half_spaces;
                all.quadrics += facts.quadrics;
            }
            if (open.size() == before) known_[canonical] = all;
        }
    }
    return known_.at(root);
}

}  // namespace deburr
