// Lobb, figure 13: increasing the radius of the filter.
#include "figures/figure.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    const Scene scene = context.scene("variable_rounding.lua", {{"light", "studio"}});
    context.picture(context.render(scene, {.width = 840, .height = 532, .spp = 48, .noise = 0.006}));
    std::string volumes;
    for (std::size_t i = 1; i < scene.solids.size(); ++i) {
        const SolidTree tree = flatten(scene.solids[i]);
        const double radius = tree.min_radius();
        const double v = volume(triage(tree, polygonization_box(tree), {.tolerance = 0.01 * radius}));
        volumes += fmt::format("{}{:.3f} (r = {:g})", i > 1 ? ", " : "", v, radius);
    }
    const SolidTree sharp = flatten(context.scene("variable_rounding.lua", {{"softness", "0"}}).solids.at(1));
    context.measured(fmt::format("The volume goes down smoothly, {}; the sharp object's is {:.3f}.", volumes,
                                 volume(triage(sharp, polygonization_box(sharp)))));
}

const RegisteredFigure registered{{
    .name = "lobb-13",
    .title = "Figure 13: increasing the radius of the smoothing filter",
    .shows = "The cube with a rounded pit (obj4 of figure 12). From the back left the radii are 0.01, 0.05, 0.1, 0.2, "
             "0.3 and 0.5.",
    .claim = "A smooth transition from pure polyhedral modelling to \"blobby\" modelling (§4.1).",
    .scenes = {"variable_rounding.lua"},
    .seconds = 20,
    .make = make,
}};

}  // namespace
}  // namespace deburr
