// Lobb, figure 12: what rounding does at different stages of modelling.
#include "figures/figure.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    const Scene scene = context.scene("csg_examples.lua");
    context.picture(context.render(scene, {.width = 900, .height = 570, .spp = 64}));
    context.measured(fmt::format("{} objects, all edges rounded with {} by name alone: no fillet was modelled.",
                                 scene.solids.size() - 1, scene.parameters.at("r")));
}

const RegisteredFigure registered{{
    .name = "lobb-12",
    .title = "Figure 12: different set operations on rounded objects",
    .shows = "From the back left: everything sharp; only the cube rounded; only the pit rounded; cube and pit "
             "rounded as one density; a union of two rounded boxes; their rounded sum, which flows together.",
    .claim = "What is rounded, and where, is chosen by the place of the rounding in the CSG tree (§4.1, figure 11).",
    .scenes = {"csg_examples.lua"},
    .seconds = 6,
    .make = make,
}};

}  // namespace
}  // namespace deburr
