#include "raytracer/scene/scene_functions.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <lua.hpp>

#include "raytracer/scene/lua_sandbox.hpp"

namespace deburr {

std::string kind_of(const SceneObject& object) {
    struct Kind {
        const char* operator()(const Density&) const { return "a density"; }
        const char* operator()(const Solid&) const { return "a solid"; }
        const char* operator()(const Quadric&) const { return "a quadric"; }
        const char* operator()(const Perturbation&) const { return "a perturbation"; }
        const char* operator()(const Material&) const { return "a material"; }
        const char* operator()(const Light&) const { return "a light"; }
        const char* operator()(const Texture&) const { return "a texture"; }
        const char* operator()(const Background&) const { return "a sky"; }
    };
    return std::visit(Kind{}, object.is);
}

void SceneBuilder::check_size(double half_spaces) {
    if (half_spaces > most_half_spaces)
        throw std::runtime_error(fmt::format("expected at most {} half-spaces, got {}", most_half_spaces, half_spaces));
}

void SceneBuilder::spend(std::size_t steps) {
    steps_ += steps;
    if (steps_ > most_steps)
        throw std::runtime_error(
            fmt::format("expected a scene that makes at most {} parts, got one that makes more", most_steps));
}

const SceneObject* SceneBuilder::make(decltype(SceneObject::is) object, int line, std::string name) {
    spend(2);
    if (const auto* density = std::get_if<Density>(&object)) check_size(density->node().leaves);
    if (const auto* solid = std::get_if<Solid>(&object)) check_size(solid->node().leaves);
    return &objects_.emplace_back(SceneObject{std::move(object), std::move(name), line});
}

Solid SceneBuilder::solid(const SceneObject& object) {
    if (const auto* solid = std::get_if<Solid>(&object.is)) return *solid;
    spend(2);
    if (const auto* quadric = std::get_if<Quadric>(&object.is))
        return solid_of_form("quadric", *quadric, {}, object.line);
    return Solid::sharp(std::get<Density>(object.is), object.line);
}

int SceneBuilder::index_of(const SceneObject* material) {
    const auto [at, is_new] = indices_.try_emplace(material, int(materials_.size()));
    if (is_new) materials_.push_back(std::get<Material>(material->is));
    return at->second;
}

static bool from_text(const std::string& text, long long& value) {
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end;
}

static bool from_text(const std::string& text, double& value) {
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end && std::isfinite(value);
}

SceneResult SceneBuilder::parameter(const std::string& name, const LuaValue& fallback) {
    const std::string place = "param '" + name + "'";
    const bool is_number = std::holds_alternative<double>(fallback);
    const bool is_bool = std::holds_alternative<bool>(fallback);
    if (!is_number && !is_bool && !std::holds_alternative<std::string>(fallback))
        expected(place, "a number, boolean or text as default", fallback);

    const auto define = defines_.find(name);
    if (define == defines_.end()) {
        const auto* string = std::get_if<std::string>(&fallback);
        parameters_[name] = string ? *string : described(fallback);
        return Argument{2};
    }
    const std::string& given = define->second;
    const auto wrong = [&](const char* what) {
        return BadValue(place, fmt::format("expected {} after -D {}=, got '{}'", what, name, given));
    };
    parameters_[name] = given;
    if (is_number) {
        long long whole = 0;
        double value = 0;
        if (from_text(given, whole)) return whole;
        if (from_text(given, value)) return value;
        throw wrong("a number");
    }
    if (is_bool) {
        if (given != "true" && given != "false") throw wrong("true or false");
        return given == "true";
    }
    return given;
}

const LuaValue& SceneCall::argument(std::size_t index) const {
    static const LuaValue nil;
    return index < arguments.size() ? arguments[index] : nil;
}

void SceneCall::at_most(std::size_t count) const {
    if (arguments.size() <= count) return;
    throw BadValue(
        name, fmt::format("expected at most {} argument{}, got {}", count, count == 1 ? "" : "s", arguments.size()));
}

namespace {

// Copying a value out of Lua takes as long as some 20 instructions.
constexpr std::int64_t work_per_value = 20;

// Everything between Lua's two worlds: no exception leaves it, and it calls nothing of Lua that
// raises. False: the message is set.
bool call_body(lua_State* lua, SceneBuilder& builder, const SceneFunction& function) noexcept {
    int line = 0;
    builder.values = builder.work = 0;
    const auto fail = [&](const char* what) {
        if (line > 0)
            std::snprintf(builder.message, sizeof builder.message, "%c:%d: %s", file_mark, line, what);
        else
            std::snprintf(builder.message, sizeof builder.message, "%c: %s", file_mark, what);
        return false;
    };
    try {
        line = current_line(lua);
        SceneCall call{builder, function.name, line, {}};
        for (int i = 1, last = lua_gettop(lua); i <= last; ++i)
            call.arguments.push_back(read_value(lua, i, function.name, &builder.values));
        builder.result = function.body(call);
        return true;
    } catch (const std::bad_alloc&) {
        return fail("expected a scene that fits into memory, got one that does not");
    } catch (const BadValue& error) {
        return fail(error.what());
    } catch (const std::exception& error) {
        char what[1024];
        std::snprintf(what, sizeof what, "%s: %s", function.name, error.what());
        return fail(what);
    }
}

int push_result(lua_State* lua, const SceneResult& result) {
    switch (result.index()) {
        case 0: lua_pushvalue(lua, std::get<Argument>(result).index); return 1;
        case 1: lua_pushlightuserdata(lua, const_cast<SceneObject*>(std::get<const SceneObject*>(result))); return 1;
        case 2: lua_pushboolean(lua, std::get<bool>(result)); return 1;
        case 3: lua_pushnumber(lua, std::get<double>(result)); return 1;
        case 4: lua_pushinteger(lua, std::get<long long>(result)); return 1;
        default: {
            const auto& text = std::get<std::string>(result);
            lua_pushlstring(lua, text.data(), text.size());
            return 1;
        }
    }
}

// No object with a destructor here: what follows the body may raise.
int call_from_lua(lua_State* lua) {
    const auto* function = static_cast<const SceneFunction*>(lua_touserdata(lua, lua_upvalueindex(1)));
    auto* builder = static_cast<SceneBuilder*>(Sandbox::host(lua));
    luaL_checkstack(lua, read_value_slots, "too many arguments");
    Sandbox::allow_abandoning(lua, false);
    const bool done = call_body(lua, *builder, *function);
    Sandbox::allow_abandoning(lua, true);
    Sandbox::spend(lua, builder->work + work_per_value * builder->values);
    if (done) return push_result(lua, builder->result);
    lua_pushstring(lua, builder->message);
    return lua_error(lua);
}

// __index of objects; upvalue: the methods.
int find_method(lua_State* lua) {
    lua_settop(lua, 2);
    lua_pushvalue(lua, 2);
    if (lua_rawget(lua, lua_upvalueindex(1)) != LUA_TNIL) return 1;
    const char* name = lua_type(lua, 2) == LUA_TSTRING ? lua_tostring(lua, 2) : luaL_typename(lua, 2);
    return luaL_error(lua,
                      "expected a method (translate, scale, rotate, mirror, radius, material, name), "
                      "got '%s'",
                      name);
}

int object_text(lua_State* lua) {  // without the address, which differs from run to run
    lua_pushliteral(lua, "object");
    return 1;
}

void push_function(lua_State* lua, const SceneFunction& function) {
    lua_pushlightuserdata(lua, const_cast<SceneFunction*>(&function));
    lua_pushcclosure(lua, call_from_lua, 1);
}

}  // namespace

void open_scene_functions(lua_State* lua) {
    lua_pushlightuserdata(lua, nullptr);  // all light userdata share one metatable
    lua_newtable(lua);
    const int meta = lua_gettop(lua);
    lua_newtable(lua);
    const int methods = lua_gettop(lua);
    for (const auto* functions : {&shape_functions(), &form_functions(), &look_functions()})
        for (const SceneFunction& function : *functions) {
            push_function(lua, function);
            switch (function.place) {
                case SceneFunction::Place::global: lua_setglobal(lua, function.name); break;
                case SceneFunction::Place::method: lua_setfield(lua, methods, function.name); break;
                case SceneFunction::Place::metamethod: lua_setfield(lua, meta, function.symbol); break;
            }
        }
    lua_pushcclosure(lua, find_method, 1);
    lua_setfield(lua, meta, "__index");
    lua_pushcfunction(lua, object_text);
    lua_setfield(lua, meta, "__tostring");
    lua_pushboolean(lua, 0);
    lua_setfield(lua, meta, "__metatable");
    lua_setmetatable(lua, -2);
    lua_pop(lua, 1);
}

}  // namespace deburr
