// Round primitives in scenes: sphere, cylinder, cone and torus as densities [docs/design.md, Round primitives].
#include <fmt/format.h>

#include "raytracer/scene/scene_functions.hpp"

namespace deburr {
namespace {

Fields fields_of(const SceneCall& call, std::initializer_list<const char*> known) {
    call.at_most(1);
    if (!as_table(call.argument(0))) expected(call.name, "a table of fields", call.argument(0));
    return {call.argument(0), call.name, known};
}

Vec3 vector_or(const Fields& fields, const char* name, Vec3 otherwise) {
    const LuaValue* given = fields.find(name);
    return given ? vector(*given, fields.location(name)) : otherwise;
}

double length_of(const Fields& fields, const char* name) {
    return number_above(fields.get(name), fields.location(name), 0);
}

double length_or(const Fields& fields, const char* name, double otherwise) {
    return fields.find(name) ? length_of(fields, name) : otherwise;
}

struct Ends {
    Vec3 from, to;
};

Ends ends_of(const SceneCall& call, const Fields& fields) {
    const Ends ends{vector(fields.get("from"), fields.location("from")),
                    vector(fields.get("to"), fields.location("to"))};
    const double length = glm::distance(ends.from, ends.to);
    if (!(length > 0 && std::isfinite(length)))
        throw BadValue(call.name, "expected two ends, from and to, that are apart, got the same point twice");
    return ends;
}

SceneResult sphere(SceneCall& call) {
    const Fields fields = fields_of(call, {"center", "radius"});
    return call.make(Density::sphere(vector_or(fields, "center", Vec3(0.0)), length_or(fields, "radius", 1)));
}

SceneResult torus(SceneCall& call) {
    const Fields fields = fields_of(call, {"center", "axis", "radius", "tube"});
    const LuaValue* given = fields.find("axis");
    if (!given) call.builder.up_mattered = true;
    const Vec3 up = call.builder.z_up ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    const Vec3 axis = given ? direction(*given, fields.location("axis")) : up;
    const double radius = length_of(fields, "radius"), tube = length_of(fields, "tube");
    if (tube > radius)
        throw BadValue(call.name, fmt::format("expected a tube that is at most the radius, so that the hole stays "
                                              "open, got {:g} > {:g}",
                                              tube, radius));
    return call.make(Density::torus(vector_or(fields, "center", Vec3(0.0)), axis, radius, tube));
}

}  // namespace

SceneResult round_cylinder(SceneCall& call) {
    const Fields fields = fields_of(call, {"from", "to", "radius"});
    const Ends ends = ends_of(call, fields);
    call.builder.keep_half_spaces(3);
    return call.make(Density::cylinder(ends.from, ends.to, length_or(fields, "radius", 1)));
}

SceneResult round_cone(SceneCall& call) {
    const Fields fields = fields_of(call, {"from", "to", "radius"});
    const Ends ends = ends_of(call, fields);
    const LuaTable* pair = as_table(fields.get("radius"));
    const std::string location = fields.location("radius");
    if (!pair || pair->list.size() != 2 || !pair->fields.empty())
        expected(location, "two radii {at from, at to}", fields.get("radius"));
    const double first = number_at_least(pair->list[0], location, 0),
                 second = number_at_least(pair->list[1], location, 0);
    if (first == 0 && second == 0) throw BadValue(location, "expected two radii that are not both 0, got {0, 0}");
    call.builder.keep_half_spaces(3);
    return call.make(Density::cone(ends.from, ends.to, first, second));
}

const std::vector<SceneFunction>& round_functions() {
    using Kind = SceneFunction::Kind;
    static const std::vector<SceneFunction> functions = {
        {Kind::global, "sphere", "", sphere},
        {Kind::global, "torus", "", torus},
    };
    return functions;
}

}  // namespace deburr
