// Rounding in scenes: rounded, convolved and sharp make a solid from a density or a model, and d:radius(r) gives a part
// of a density its own radius.
#include "bounds/density_tree.hpp"
#include "raytracer/scene/round_convolution.hpp"
#include "raytracer/scene/scene_arguments.hpp"

namespace deburr {
namespace {

// Instructions that take as long as flattening one part.
constexpr std::int64_t work_per_round_part = 20;

SceneResult rounded(SceneCall& call) {
    call.at_most(2);
    const double radius = number_at_least(call.argument(0), call.location("radius"), 0);
    const Density& density = need_density(call.argument(1), call.name);
    if (density.node().has_round) {
        SceneBuilder::check_size(density.node().leaves);
        call.builder.spend(work_per_round_part * std::int64_t(density.node().leaves));
        try {
            flatten(density, radius);
        } catch (const BadRoundPart& error) {
            throw BadValue(call.name, error.what());
        }
    }
    return call.make(Solid::rounded(radius, density, call.line));
}

SceneResult convolved(SceneCall& call) {
    call.at_most(3);
    const double radius = number_above(call.argument(0), call.location("radius"), 0);
    const LuaValue& options = call.argument(2);
    const KeepSharp keep = is_nil(options) ? KeepSharp{} : keep_sharp(options, call.location("options"));
    if (const auto* model = as<PlacedModel>(as_object(call.argument(1))))
        return call.make(call.builder.solid(*model, radius, call.line, keep));
    if (keep.any()) expected(call.name, "a model where something is kept sharp", call.argument(1));
    const Density& density = need_density(call.argument(1), call.name, "a density or a model");
    if (density.has_radius())
        throw BadValue(call.name,
                       "expected a density without radii, got one with :radius(); one ball rounds all of it");
    if (density.node().has_round) {
        try {
            return call.make(convolved_round(radius, density, call.line));
        } catch (const BadRoundPart& error) {
            throw BadValue(call.name, error.what());
        } catch (const NoRoundConvolution& error) {
            throw BadValue(call.name, error.what());
        }
    }
    return call.make(Solid::convolved(radius, density, call.line));
}

SceneResult sharp(SceneCall& call) {
    call.at_most(1);
    if (const auto* model = as<PlacedModel>(as_object(call.argument(0))))
        return call.make(call.builder.solid(*model, 0, call.line));
    return call.make(Solid::sharp(need_density(call.argument(0), call.name, "a density or a model"), call.line));
}

SceneResult radius(SceneCall& call) {
    call.at_most(2);
    const Density& density = need_density(call.argument(0), call.name);
    return call.make(density.radius(number_at_least(call.argument(1), call.name, 0)));
}

}  // namespace

const std::vector<SceneFunction>& rounding_functions() {
    using Kind = SceneFunction::Kind;
    static const std::vector<SceneFunction> functions = {
        {Kind::global, "rounded", "", rounded},
        {Kind::global, "convolved", "", convolved},
        {Kind::global, "sharp", "", sharp},
        {Kind::method, "radius", "", radius},
    };
    return functions;
}

}  // namespace deburr
