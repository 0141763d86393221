// Methods of a scene's objects: transforms (translate, scale, rotate, mirror), a solid's material and its name.
#include "raytracer/scene/scene_arguments.hpp"

namespace deburr {
namespace {

SceneResult material(SceneCall& call) {
    call.at_most(2);
    const SceneObject& self = need_set(call.argument(0), call.name);
    const SceneObject* given = as_object(call.argument(1));
    if (!as<Material>(given)) expected(call.name, "a material", call.argument(1));
    return call.make(call.builder.solid(self).material(call.builder.index_of(given)), self.name);
}

SceneResult name(SceneCall& call) {
    call.at_most(2);
    const std::string location = call.name;
    const SceneObject& self = need_set(call.argument(0), call.name);
    const std::string& given = text(call.argument(1), location);
    call.builder.memory->take_text(given.size());
    return call.make(call.builder.solid(self), std::make_shared<const std::string>(given));
}

SceneResult transform(SceneCall& call, const Affine& map) {
    const SceneObject& self = need_movable(call.argument(0), call.name);
    if (const auto* density = as<Density>(&self)) {
        if (density->node().has_round && even_scale(map) == 0)
            throw BadValue(call.name,
                           "expected one factor for a density with round parts, got several; scale the "
                           "rounded solid, as in rounded(r, d):scale(x, y, z)");
        return call.make(density->transformed(map));
    }
    if (const auto* quadric = as<Quadric>(&self)) return call.make(ordinary(transformed(*quadric, map), call.name));
    if (const auto* model = as<PlacedModel>(&self))
        return call.make(PlacedModel{model->mesh, compose(map, model->map), model->file});
    if (const auto* p = as<Perturbation>(&self))
        return call.make(Perturbation{p->factor, ordinary(transformed(p->quadric, map), call.name)});
    return call.make(as<Solid>(&self)->transformed(map), self.name);
}

SceneResult translate(SceneCall& call) {
    call.at_most(4);
    need_movable(call.argument(0), call.name);
    Affine map;
    for (int k = 0; k < 3; ++k)
        map.shift[k] = number(call.argument(std::size_t(k) + 1), call.location(&"x\0y\0z"[2 * k]));
    return transform(call, map);
}

SceneResult scale(SceneCall& call) {
    call.at_most(4);
    need_movable(call.argument(0), call.name);
    const bool even = call.arguments.size() <= 2;
    Affine map;
    for (int k = 0; k < 3; ++k) {
        const LuaValue& given = call.argument(even ? 1 : std::size_t(k) + 1);
        const std::string where = even ? call.name : call.location(&"x\0y\0z"[2 * k]);
        const double factor = number(given, where);
        // With this limit products of three factors and their inverses stay far inside the range of a double.
        constexpr double largest = 1e100;
        if (!(std::abs(factor) <= largest && std::abs(factor) >= 1 / largest))
            expected(where, "a factor that leaves a volume, for 0 is singular", given);
        map.linear[k][k] = factor;
    }
    return transform(call, map);
}

// Exact at multiples of 90 degrees about an axis, so that planes stay axis-parallel.
SceneResult rotate(SceneCall& call) {
    call.at_most(3);
    need_movable(call.argument(0), call.name);
    const double degrees = std::fmod(number(call.argument(1), call.location("degrees")), 360.0);
    const Vec3 k = direction(call.argument(2), call.location("axis"));
    const int quarters = int(degrees / 90);
    const bool exact = quarters * 90.0 == degrees;
    constexpr double cosines[4] = {1, 0, -1, 0};
    const double c = exact ? cosines[(quarters + 4) % 4] : std::cos(glm::radians(degrees));
    const double s = exact ? cosines[(quarters + 3) % 4] : std::sin(glm::radians(degrees));
    // Rodrigues' formula: R = k kᵀ + cos (1 − k kᵀ) + sin [k]×
    const Mat3 along = glm::outerProduct(k, k);
    const Mat3 across(Vec3(0, k.z, -k.y), Vec3(-k.z, 0, k.x), Vec3(k.y, -k.x, 0));  // column by column
    Affine map;
    map.linear = along + c * (Mat3(1.0) - along) + s * across;
    return transform(call, map);
}

// Reflects in the plane through the origin with this normal.
SceneResult mirror_method(SceneCall& call) {
    call.at_most(2);
    need_movable(call.argument(0), call.name);
    const Vec3 n = direction(call.argument(1), call.location("normal"));
    Affine map;
    map.linear = Mat3(1.0) - 2.0 * glm::outerProduct(n, n);
    return transform(call, map);
}

}  // namespace

const std::vector<SceneFunction>& method_functions() {
    using Kind = SceneFunction::Kind;
    static const std::vector<SceneFunction> functions = {
        {Kind::method, "material", "", material},   {Kind::method, "name", "", name},
        {Kind::method, "translate", "", translate}, {Kind::method, "scale", "", scale},
        {Kind::method, "rotate", "", rotate},       {Kind::method, "mirror", "", mirror_method},
    };
    return functions;
}

}  // namespace deburr
