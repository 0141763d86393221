// Lobb, figure 14: two staplers, one of them softly rounded.
#include "bounds/solid_tree.hpp"
#include "figures/figure.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    const Scene scene = context.scene("staplers.lua");
    context.picture(context.render(scene, {.width = 840, .height = 532, .spp = 128, .noise = 0.01}));
    std::size_t half_spaces = 0, sharp = 0;
    const SolidTree soft = flatten(context.scene("staplers.lua", {{"show", "rounded"}}).solids.at(0));
    double least = infinity, greatest = 0;
    for (const SolidLeaf& leaf : soft.leaves)
        for (const HalfSpace& h : leaf.density.half_spaces) {
            ++half_spaces;
            if (h.radius == 0)
                ++sharp;
            else
                least = std::min(least, h.radius), greatest = std::max(greatest, h.radius);
        }
    context.measured(fmt::format(
        "The stapler has {} leaves and {} half-spaces, with radii from {:.2g} to {:.2g} cm ({} half-spaces are sharp); "
        "the other differs in its radii only.",
        soft.leaves.size(), half_spaces, least, greatest, sharp));
}

const RegisteredFigure registered{{
    .name = "lobb-14",
    .title = "Figure 14: rounding for a softer, more natural appearance",
    .shows = "Two staplers of the same CSG operations on a wooden desk. In front every part has a radius of its own, "
             "at the back all radii are 0.",
    .claim = "Small roundings soften the look, do away with Mach bands, and show where parts meet: at the base on the "
             "ground and under the "
             "staple holder (§4.1).",
    .scenes = {"staplers.lua"},
    .seconds = 50,
    .make = make,
}};

}  // namespace
}  // namespace deburr
