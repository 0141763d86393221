// Operators in scenes: + * - of densities, and | & - ~ of densities and of solids.
#include "raytracer/scene/scene_arguments.hpp"

namespace deburr {
namespace {

using DensityOperator = Density (*)(Density, Density, int);
using SolidOperator = Solid (*)(Solid, Solid);

// Applies the first operator to two densities, and else the second one, if there is one, to two solids.
SceneResult combine(SceneCall& call, DensityOperator of_densities, SolidOperator of_solids) {
    const LuaValue &a = call.argument(0), &b = call.argument(1);
    if (as_density(a) && as_density(b)) return call.make(of_densities(*as_density(a), *as_density(b), call.line));
    const LuaValue& wrong = (of_solids ? is_set(a) : as_density(a) != nullptr) ? b : a;
    if (!of_solids) expected(call.name, "densities on both sides (solids have | & -)", wrong);
    if (!is_set(wrong)) expected(call.name, "densities or solids on both sides", wrong);
    return call.make(of_solids(call.builder.solid(*as_object(a)), call.builder.solid(*as_object(b))));
}

SceneResult add(SceneCall& call) { return combine(call, &Density::sum, nullptr); }

SceneResult multiply(SceneCall& call) {
    return combine(call, static_cast<DensityOperator>(&Density::product), nullptr);
}

SceneResult subtract(SceneCall& call) {
    return combine(call, &Density::difference, [](Solid a, Solid b) { return a - b; });
}

SceneResult disjoin(SceneCall& call) {
    return combine(
        call, [](Density a, Density b, int) { return a | b; }, [](Solid a, Solid b) { return a | b; });
}

SceneResult conjoin(SceneCall& call) {
    return combine(
        call, [](Density a, Density b, int) { return a & b; }, [](Solid a, Solid b) { return a & b; });
}

SceneResult complement(SceneCall& call) {
    const Density* density = as_density(call.argument(0));
    if (!density) expected(call.name, "a density", call.argument(0));
    return call.make(~*density);
}

// Lua has a binary operator ~, too.
SceneResult complement_of_two(SceneCall& call) {
    throw BadValue(call.name, "expected one density, as in a & ~b, got two, as in a ~ b");
}

}  // namespace

const std::vector<SceneFunction>& operator_functions() {
    using Kind = SceneFunction::Kind;
    static const std::vector<SceneFunction> functions = {
        {Kind::metamethod, "operator +", "__add", add},
        {Kind::metamethod, "operator *", "__mul", multiply},
        {Kind::metamethod, "operator -", "__sub", subtract},
        {Kind::metamethod, "operator |", "__bor", disjoin},
        {Kind::metamethod, "operator &", "__band", conjoin},
        {Kind::metamethod, "operator ~", "__bnot", complement},
        {Kind::metamethod, "operator ~", "__bxor", complement_of_two},
    };
    return functions;
}

}  // namespace deburr
