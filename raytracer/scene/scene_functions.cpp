#include "raytracer/scene/scene_functions.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <lua.hpp>

#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/name_hints.hpp"
#include "raytracer/scene/scene_descriptions.hpp"
#include "raytracer/util/count_text.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {

std::string kind_of(const SceneObject& object) {
    static constexpr const char* kinds[] = {"a density", "a solid",   "a quadric", "a perturbation", "a material",
                                            "a light",   "a texture", "a sky",     "a model",        "a framing"};
    static_assert(std::size(kinds) == std::variant_size_v<decltype(object.is)>);
    return kinds[object.is.index()];
}

void SceneBuilder::check_size(double half_spaces) {
    if (half_spaces > max_half_spaces)
        throw std::runtime_error(fmt::format("expected at most {} half-spaces, got {}", count_text(max_half_spaces),
                                             count_text(half_spaces)));
}

// Bytes of a node allocated by make_shared.
template <class Node>
constexpr std::size_t node_block = block_bytes(sizeof(Node) + 2 * sizeof(void*));

// Bytes of a node and its list of children, which has a block of its own if there are more than two.
template <class Node>
static std::size_t node_bytes(const Node& node) {
    const auto children = node.children();
    return node_block<Node> + (children.size() > 2 ? block_bytes(children.size_bytes()) : 0);
}

void SceneBuilder::keep_parts(std::size_t bytes) {
    part_bytes_ += bytes;
    if (part_bytes_ > max_part_bytes_)
        throw std::runtime_error(fmt::format(
            "expected a scene whose parts take at most {} MiB, got one whose take more", max_part_bytes_ >> 20));
}

void SceneBuilder::keep_half_spaces(std::size_t count) {
    keep_parts(count * (node_block<DensityNode> + sizeof(Density)));
}

void SceneBuilder::spend(std::int64_t amount) {
    if (amount > work_left - work) throw WorkSpent();
    work += amount;
}

void SceneBuilder::borrow(std::size_t bytes) {
    memory->take(bytes);
    cost.bytes += bytes;
}

const SceneObject* SceneBuilder::keep(SceneObject object) {
    const auto* density = as<Density>(&object);
    const auto* solid = as<Solid>(&object);
    keep_parts(sizeof(SceneObject) + (density ? node_bytes(density->node()) : solid ? node_bytes(solid->node()) : 0));
    if (density) check_size(density->node().leaves);
    // Unions share parts that are placed repeatedly; other operators flatten everything below them.
    if (solid && is_laid_out(solid->node())) check_size(solid->node().leaves);
    return &objects_.emplace_back(std::move(object));
}

Solid SceneBuilder::solid(const SceneObject& object) {
    if (const auto* solid = as<Solid>(&object)) return *solid;
    keep_parts(node_block<SolidNode>);
    if (const auto* model = as<PlacedModel>(&object)) return solid(*model, 0, object.line);
    if (const auto* quadric = as<Quadric>(&object)) return solid_of_free_form("quadric", *quadric, {}, object.line);
    return Solid::sharp(*as<Density>(&object), object.line);
}

int SceneBuilder::index_of(const SceneObject* material) {
    const auto [at, is_new] = indices_.try_emplace(material, int(materials_.size()));
    if (is_new) materials_.push_back(*as<Material>(material));
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
    const std::string location = "param '" + shortened(name, 40) + "'";
    const bool is_number = std::holds_alternative<double>(fallback);
    const bool is_bool = std::holds_alternative<bool>(fallback);
    if (!is_number && !is_bool && !std::holds_alternative<std::string>(fallback))
        expected(location, "a number, boolean or text as default", fallback);

    // Name and value are stored here and in the scene.
    const auto keep = [&](const std::string& value) {
        if (parameters_.count(name) == 0)
            memory->take(2 * (block_bytes(sizeof(std::pair<std::string, std::string>) + 4 * sizeof(void*)) +
                              block_bytes(name.size() + 1)));
        memory->take(2 * block_bytes(value.size() + 1));
        parameters_[name] = value;
    };
    const auto define = defines_.find(name);
    if (define == defines_.end()) {
        const auto* string = std::get_if<std::string>(&fallback);
        keep(string ? *string : described(fallback));
        return Argument{2};
    }
    const std::string& given = define->second;
    const auto wrong = [&](const char* what) {
        return BadValue(location, fmt::format("expected {} after -D {}=, got '{}'", what, name, given));
    };
    keep(given);
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
    throw BadValue(name, fmt::format("expected at most {}, got {}", count_of(count, "argument"), arguments.size()));
}

namespace {

// Instructions that take as long as copying a value out of Lua.
constexpr std::int64_t work_per_value = 20;

// Instructions that take as long as an exception with its message.
constexpr std::int64_t work_per_failure = 500;

enum class Ending { done, failed, memory_spent, no_memory, work_spent };

// The boundary between Lua and C++: no exception leaves it, and it calls no Lua function that raises. If it fails,
// builder.message is set.
Ending call_body(lua_State* lua, SceneBuilder& builder, const SceneFunction& function) noexcept {
    int line = 0;
    const auto fail = [&](const char* what) {
        if (line > 0)
            std::snprintf(builder.message, sizeof builder.message, "%c:%d: %s", file_mark, line, what);
        else
            std::snprintf(builder.message, sizeof builder.message, "%c: %s", file_mark, what);
        return Ending::failed;
    };
    try {
        line = current_line(lua);
        SceneCall call{builder, function.name, line, {}};
        for (int i = 1, last = lua_gettop(lua); i <= last; ++i)
            call.arguments.push_back(read_value(lua, i, function.name, builder.memory, &builder.cost));
        builder.spend(work_per_value * builder.cost.values);
        builder.result = function.body(call);
        return Ending::done;
    } catch (const MemorySpent&) {
        return Ending::memory_spent;
    } catch (const WorkSpent&) {
        return Ending::work_spent;
    } catch (const std::bad_alloc&) {
        return Ending::no_memory;
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

int call_from_lua(lua_State* lua) {
    return call_scene_function(lua, *static_cast<const SceneFunction*>(lua_touserdata(lua, lua_upvalueindex(1))));
}

}  // namespace

// No object with a destructor may live here, since the code after the body may raise.
int call_scene_function(lua_State* lua, const SceneFunction& function) {
    luaL_checkstack(lua, read_value_slots, "too many arguments");
    const HostCall visit = HostCall::enter(lua);
    auto* builder = static_cast<SceneBuilder*>(visit.host);
    builder->memory = visit.memory;
    builder->sources = visit.sources;
    builder->work_left = visit.work_left;
    builder->work = 0;
    builder->cost = {};
    const Ending ending = call_body(lua, *builder, function);
    visit.memory->give_back(builder->cost.bytes);
    if (ending == Ending::failed) builder->work += work_per_failure;
    const Memory memory = ending == Ending::memory_spent ? Memory::spent
                          : ending == Ending::no_memory  ? Memory::none
                                                         : Memory::enough;
    visit.leave(ending == Ending::work_spent ? visit.work_left + 1 : builder->work, memory);
    if (ending == Ending::done) return push_result(lua, builder->result);
    lua_pushstring(lua, builder->message);
    return lua_error(lua);
}

namespace {

// The __index of objects. Upvalue: the table of methods.
int find_method(lua_State* lua) {
    lua_settop(lua, 2);
    lua_pushvalue(lua, 2);
    if (lua_rawget(lua, lua_upvalueindex(1)) != LUA_TNIL) return 1;
    const char* name = lua_type(lua, 2) == LUA_TSTRING ? lua_tostring(lua, 2) : luaL_typename(lua, 2);
    return luaL_error(lua,
                      "expected a method (translate, scale, rotate, mirror, radius, material, name), "
                      "got '%s'%s",
                      name, instead_of_name(name));
}

SceneResult object_text(SceneCall& call) {
    const SceneObject& object = *as_object(call.argument(0));
    // Instructions that take as long as bounding one half-space.
    constexpr double work_per_half_space = 100;
    call.builder.spend(std::int64_t(work_per_half_space * work_to_describe(object)));
    return description(object);
}

SceneResult param(SceneCall& call) {
    call.at_most(2);
    return call.builder.parameter(text(call.argument(0), call.location("name")), call.argument(1));
}

constexpr SceneFunction text_function{SceneFunction::Kind::metamethod, "tostring", "__tostring", object_text};

void push_function(lua_State* lua, const SceneFunction& function) {
    lua_pushlightuserdata(lua, const_cast<SceneFunction*>(&function));
    lua_pushcclosure(lua, call_from_lua, 1);
}

}  // namespace

const std::vector<SceneFunction>& parameter_functions() {
    static const std::vector<SceneFunction> functions = {{SceneFunction::Kind::global, "param", "", param}};
    return functions;
}

std::vector<const SceneFunction*> scene_functions() {
    std::vector<const SceneFunction*> all;
    for (const auto* functions :
         {&shape_functions(), &round_functions(), &free_form_functions(), &model_functions(), &operator_functions(),
          &method_functions(), &rounding_functions(), &material_functions(), &parameter_functions()})
        for (const SceneFunction& function : *functions) all.push_back(&function);
    return all;
}

void open_scene_functions(lua_State* lua) {
    lua_pushlightuserdata(lua, nullptr);  // all light userdata share one metatable
    lua_newtable(lua);
    const int meta = lua_gettop(lua);
    lua_newtable(lua);
    const int methods = lua_gettop(lua);
    for (const SceneFunction* function : scene_functions()) {
        push_function(lua, *function);
        switch (function->kind) {
            case SceneFunction::Kind::global: lua_setglobal(lua, function->name); break;
            case SceneFunction::Kind::method: lua_setfield(lua, methods, function->name); break;
            case SceneFunction::Kind::metamethod: lua_setfield(lua, meta, function->symbol); break;
        }
    }
    lua_pushcclosure(lua, find_method, 1);
    lua_setfield(lua, meta, "__index");
    push_function(lua, text_function);
    lua_setfield(lua, meta, "__tostring");
    lua_pushcfunction(lua, include_part);
    lua_setglobal(lua, "include");
    lua_pushboolean(lua, 0);
    lua_setfield(lua, meta, "__metatable");
    lua_setmetatable(lua, -2);
    lua_pop(lua, 1);
}

}  // namespace deburr
