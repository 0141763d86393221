#include "raytracer/scene/solid_survey.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bounds/bounding_box.hpp"
#include "bounds/free_form.hpp"
#include "bounds/round_density.hpp"
#include "bounds/selective_mesh_field.hpp"
#include "bounds/torus.hpp"

namespace deburr {
namespace {

// Whether the half-space is a part of its own: not the other side of a cone, nor the lower end of a draw.
bool is_part(const HalfSpace& h) { return h.round && !h.round->is_concave() && (h.offset > 0 || h.round->is_cone()); }

SolidFacts facts_of(const SolidTree& tree) {
    SolidFacts facts;
    facts.box = bounding_box(tree);
    for (const SolidLeaf& leaf : tree.leaves) {
        const auto* form = dynamic_cast<const FreeForm*>(leaf.field.get());
        if (form) facts.quadrics += 1.0 + double(form->perturbations().size());
        facts.half_spaces += double(leaf.density.half_spaces.size());
        if (dynamic_cast<const Torus*>(leaf.field.get())) ++facts.round_parts;
        if (const auto* density = dynamic_cast<const RoundDensity*>(leaf.field.get()))
            for (const HalfSpace& h : density->tree().half_spaces) {
                facts.half_spaces += h.round == nullptr;
                facts.round_parts += is_part(h);
            }
    }
    return facts;
}

// The mean factor by which the map scales lengths: the cube root of that of volumes.
double scale_of(const Affine& map) { return std::cbrt(std::abs(glm::determinant(map.linear))); }

void add_models(const Solid& solid, SolidFacts& facts) {
    for_each_leaf(
        {solid}, [](const SolidNode&) { return true; },
        [&](const Solid& leaf, const Affine& map) {
            const MeshField* model = mesh_field_of(leaf.node().field().get());
            if (!model) return;
            const double scale = scale_of(map);
            facts.triangles += double(model->mesh().size());
            facts.faces += double(model->mesh().planes());
            facts.model_volume += model->mesh().volume() * scale * scale * scale;
            facts.model_radius = std::max(facts.model_radius, scale * model->filter_radius());
        });
}

SolidFacts placed(const Affine& map, const SolidFacts& facts) {
    SolidFacts result = facts;
    if (!facts.box.empty()) result.box = facts.box.finite() ? image(map, facts.box) : Box::everything();
    const double scale = scale_of(map);
    result.model_volume *= scale * scale * scale;
    result.model_radius *= scale;
    return result;
}

}  // namespace

SolidFacts SolidSurvey::at(const Solid& solid) {
    if (solid.node().leaves <= max_half_spaces) {
        SolidFacts facts = facts_of(flatten(solid));
        add_models(solid, facts);
        return facts;
    }
    const CanonicalPlacement placement = canonical_.of(solid);
    return placed(placement.map, of_canonical(placement.canonical));
}

// Iterative, since unions may be long chains.
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
                all.round_parts += facts.round_parts;
                all.triangles += facts.triangles;
                all.faces += facts.faces;
                all.model_volume += facts.model_volume;
                all.model_radius = std::max(all.model_radius, facts.model_radius);
            }
            if (open.size() == before) known_[canonical] = all;
        }
    }
    return known_.at(root);
}

}  // namespace deburr
