#include "raytracer/scene/scene_arguments.hpp"

#include <fmt/format.h>

namespace deburr {

const Density* as_density(const LuaValue& value) { return as<Density>(as_object(value)); }

bool is_set(const LuaValue& value) {
    const SceneObject* object = as_object(value);
    return as<Density>(object) || as<Solid>(object) || as<Quadric>(object) || as<PlacedModel>(object);
}

const SceneObject& need_set(const LuaValue& value, const char* location) {
    if (!is_set(value)) expected(location, "a density or a solid", value);
    return *as_object(value);
}

const SceneObject& need_movable(const LuaValue& value, const char* location) {
    const SceneObject* object = as_object(value);
    if (as<Perturbation>(object)) return *object;
    return need_set(value, location);
}

const Density& need_density(const LuaValue& value, const char* location, const char* what) {
    const Density* density = as_density(value);
    if (!density && as<PlacedModel>(as_object(value)))
        expected(location, "a density; convolved(r, m) rounds a model, sharp(m) leaves it as it is", value);
    if (as<Quadric>(as_object(value)))
        throw BadValue(location,
                       "expected a density, got a quadric, which cannot be rounded with others: write sphere{…}, "
                       "cylinder{ from =, to = } or cone{ from =, to = }, or join it to rounded solids by | & -");
    if (as<Solid>(as_object(value)))
        throw BadValue(
            location,
            "expected a density, got a solid, which is rounded already: join densities first, then round, as "
            "in rounded(r, a | b)");
    if (!density) expected(location, what, value);
    return *density;
}

const std::vector<LuaValue>& need_list(const LuaValue& value, const std::string& location, const char* of_what,
                                       std::size_t most) {
    const LuaTable* table = as_table(value);
    if (!table || !table->fields.empty()) expected(location, std::string("a list of ") + of_what, value);
    if (table->list.size() > most)
        throw BadValue(location, fmt::format("expected at most {} {}, got {}", most, of_what, table->list.size()));
    return table->list;
}

std::string item(const std::string& location, std::size_t index) { return fmt::format("{}[{}]", location, index + 1); }

}  // namespace deburr
