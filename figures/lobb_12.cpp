// Lobb, figure 12: what rounding does at different stages of modelling.
#include "bounds/solid_tree.hpp"
#include "figures/figure.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    const Scene scene = context.scene("csg_examples.lua", {{"light", "studio"}});
    context.picture(context.render(scene, {.width = 840, .height = 532, .spp = 48, .noise = 0.006}));
    std::string bars;
    for (std::size_t i = 1; i < scene.solids.size(); ++i) {
        const SolidTree tree = flatten(scene.solids[i]);
        std::size_t half_spaces = 0;
        for (const SolidLeaf& leaf : tree.leaves) half_spaces += leaf.density.half_spaces.size();
        bars += fmt::format("{}{} of {}", i > 1 ? ", " : "", half_spaces, tree.leaves.size());
    }
    context.measured(fmt::format(
        "One radius, {}, and no fillet modelled: the six objects are {} half-spaces and leaves of the primary tree.",
        scene.parameters.at("r"), bars));
}

const RegisteredFigure registered{{
    .name = "lobb-12",
    .title = "Figure 12: different set operations on rounded objects",
    .shows = "From the back left: everything sharp; only the cube rounded; only the pit rounded; cube and pit "
             "rounded as one density; a union of two rounded boxes; their rounded sum, which flows together.",
    .claim = "What is rounded, and where, is chosen by the place of the rounding in the CSG tree (§4.1, figure 11).",
    .scenes = {"csg_examples.lua"},
    .seconds = 20,
    .make = make,
}};

}  // namespace
}  // namespace deburr
