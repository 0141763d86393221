#include "raytracer/scene/lua_library.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <lua.hpp>
#include <new>
#include <string>
#include <vector>

#include "raytracer/scene/lua_replacements.hpp"
#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/name_hints.hpp"
#include "raytracer/util/nearest_name.hpp"

namespace deburr {
namespace {

constexpr lua_Integer random_seed = 1991;  // any would do; it is the papers' decade

constexpr const char* gone_from_base[] = {"load", "loadfile", "loadstring",     "dofile",
                                          "warn", "next",     "collectgarbage", "require"};
constexpr const char* gone_from_string[] = {"dump", "find", "match", "gmatch", "gsub"};
constexpr const char* gone_libraries[] = {"io", "os", "package", "debug", "utf8"};

template <class Names>
bool among(const Names& names, const char* name) {
    return std::any_of(std::begin(names), std::end(names),
                       [&](const char* other) { return std::strcmp(other, name) == 0; });
}

std::int64_t as_work(double amount) {
    return amount < 1e18 ? std::int64_t(std::max(amount, 0.0)) : std::numeric_limits<std::int64_t>::max();
}

// Longer names are not compared, and none in a larger table.
constexpr std::size_t longest_known_name = 64, most_names = 2'000;

// The key of the table at index 1 that is nearest to `name`, or "". No C++ object is alive when the caller raises a Lua
// error.
std::array<char, longest_known_name + 1> nearest_of_table(lua_State* lua, const char* name) noexcept {
    std::array<char, longest_known_name + 1> nearest{};
    try {
        std::vector<std::string> names;
        for (lua_pushnil(lua); lua_next(lua, 1); lua_pop(lua, 1))
            if (std::size_t size = 0;
                lua_type(lua, -2) == LUA_TSTRING && lua_tolstring(lua, -2, &size) && size <= longest_known_name)
                names.emplace_back(lua_tostring(lua, -2), size);
        std::sort(names.begin(), names.end());  // the table's own order differs from run to run
        const std::string found = nearest_name(name, names);
        std::copy(found.begin(), found.end(), nearest.begin());
    } catch (const std::bad_alloc&) {  // the message is then without a suggestion
    }
    return nearest;
}

// The __index of the libraries. Upvalue: the prefix of the library's names, or "".
int missing_name(lua_State* lua) {
    const char* prefix = lua_tostring(lua, lua_upvalueindex(1));
    if (lua_type(lua, 2) != LUA_TSTRING) {
        lua_pushnil(lua);
        return 1;
    }
    const char* name = lua_tostring(lua, 2);
    const bool base = *prefix == 0;
    if ((base && (among(gone_from_base, name) || among(gone_libraries, name))) ||
        (std::strcmp(prefix, "string.") == 0 && among(gone_from_string, name)))
        return luaL_error(lua, "%s%s: not available in a scene%s", prefix, name,
                          std::strcmp(name, "next") == 0 ? ", use pairs" : instead_of_name(base ? name : ""));
    if (const char* instead = instead_of_name(base ? name : ""); *instead)
        return luaL_error(lua, "expected a known name, got '%s'%s", name, instead);
    std::size_t count = 0;
    for (lua_pushnil(lua); lua_next(lua, 1); lua_pop(lua, 1)) ++count;
    constexpr double work_of_name = 200;  // about the number of pairs of letters
    Sandbox::spend(lua, as_work(work_of_name * double(std::min(count, most_names))));
    const auto nearest = nearest_of_table(lua, count <= most_names ? name : "");
    if (nearest[0] == 0) return luaL_error(lua, "expected a known name, got '%s%s'", prefix, name);
    return luaL_error(lua, "expected a known name, got '%s%s', did you mean %s%s?", prefix, name, prefix,
                      nearest.data());
}

// Makes missing names of the library at the top of the stack an error.
void refuse_missing_names(lua_State* lua, const char* prefix) {
    lua_createtable(lua, 0, 2);
    lua_pushstring(lua, prefix);
    lua_pushcclosure(lua, missing_name, 1);
    lua_setfield(lua, -2, "__index");
    lua_pushboolean(lua, 0);
    lua_setfield(lua, -2, "__metatable");
    lua_setmetatable(lua, -2);
}

// Continues with the original function, upvalue 1, which has no upvalues of its own, in the same frame, so that its
// errors name the scene's line.
int call_original(lua_State* lua) { return lua_tocfunction(lua, lua_upvalueindex(1))(lua); }

// Replaces the function `name` of the library at the top of the stack by `wrapper`, which gets it as upvalue 1.
void wrap(lua_State* lua, const char* name, lua_CFunction wrapper) {
    lua_getfield(lua, -1, name);
    lua_pushcclosure(lua, wrapper, 1);
    lua_setfield(lua, -2, name);
}

// Finalizers run with hooks disabled. Lua marks an object for finalization when its metatable is set, so a __gc that is
// added to the metatable later has no effect.
int set_metatable(lua_State* lua) {
    if (lua_istable(lua, 2)) {
        lua_pushliteral(lua, "__gc");
        if (lua_rawget(lua, 2) != LUA_TNIL)
            return luaL_error(lua, "setmetatable: expected no __gc, which is not available in a scene");
        lua_pop(lua, 1);
    }
    return call_original(lua);
}

// Each coroutine counts instructions by itself, and what it does before its first sample would go unnoticed, so it is
// charged here.
int create_coroutine(lua_State* lua) {
    Sandbox::spend(lua, Sandbox::sample_interval);
    return call_original(lua);
}

// Checks the time before functions that may take long for long texts, so that the thread need not be left behind in
// them.
int heeding_time(lua_State* lua) {
    Sandbox::spend(lua, 0);
    return call_original(lua);
}

// string.rep loops as often as it is told, as in ("").rep(1e18).
int repeat_string(lua_State* lua) {
    std::size_t size = 0, separator = 0;
    luaL_checklstring(lua, 1, &size);
    const auto times = double(luaL_checkinteger(lua, 2));
    luaL_optlstring(lua, 3, "", &separator);
    constexpr double most = 1 << 24;
    if (times * double(std::max<std::size_t>(size + separator, 1)) > most)
        return luaL_error(lua, "string.rep: expected a result of at most 16777216 bytes, got more");
    Sandbox::spend(lua, as_work(times));
    return call_original(lua);
}

// Calls a function that loops over a whole table. `last` is the argument that defaults to the table's length.
template <int last>
int over_whole_table(lua_State* lua) {
    check_plain_table(lua, 1);
    const lua_Integer size = border(lua, 1);
    Sandbox::spend(lua, as_work(double(size)));
    if (lua_isnoneornil(lua, last)) {
        lua_settop(lua, last - 1);
        lua_pushinteger(lua, size);
    }
    return call_original(lua);
}

int move_range(lua_State* lua) {
    check_plain_table(lua, 1);
    if (!lua_isnoneornil(lua, 5)) check_plain_table(lua, 5);
    Sandbox::spend(lua, as_work(double(luaL_checkinteger(lua, 3)) - double(luaL_checkinteger(lua, 2))));
    return call_original(lua);
}

// Without an argument, the original would seed from the clock.
int seed_random(lua_State* lua) {
    if (lua_gettop(lua) == 0) lua_pushinteger(lua, random_seed);
    lua_pushvalue(lua, lua_upvalueindex(1));  // not by call_original, since its upvalue is the generator
    lua_insert(lua, 1);
    lua_call(lua, lua_gettop(lua) - 1, 0);
    return 0;
}

// A key of pairs(), in the order numbers, strings, booleans. Plain data, whose text is in Lua's memory.
struct Key {
    int type;  // 0 number, 1 string, 2 boolean
    bool integer;
    double number;  // boolean: 0 or 1
    lua_Integer whole;
    const char* text;
    std::size_t size;

    bool operator<(const Key& other) const {
        if (type != other.type) return type < other.type;
        if (type == 1) {
            const int order = std::memcmp(text, other.text, std::min(size, other.size));
            return order != 0 ? order < 0 : size < other.size;
        }
        if (number != other.number) return number < other.number;
        if (integer != other.integer) return integer;
        return whole < other.whole;
    }
};

// The iterator of pairs(). State: the table; upvalues: the sorted keys, and how many have been visited.
int next_pair(lua_State* lua) {
    luaL_checktype(lua, 1, LUA_TTABLE);  // a scene may call the iterator itself
    lua_Integer done = lua_tointeger(lua, lua_upvalueindex(2));
    lua_settop(lua, 1);
    for (;;) {
        lua_pushinteger(lua, ++done);
        lua_replace(lua, lua_upvalueindex(2));
        if (lua_rawgeti(lua, lua_upvalueindex(1), done) == LUA_TNIL) return 1;
        lua_pushvalue(lua, -1);
        if (lua_rawget(lua, 1) != LUA_TNIL) return 2;  // otherwise the key was removed meanwhile
        lua_pop(lua, 2);
    }
}

int pairs(lua_State* lua) {
    luaL_checkany(lua, 1);
    if (luaL_getmetafield(lua, 1, "__pairs") != LUA_TNIL) {
        lua_pop(lua, 1);
        return call_original(lua);
    }
    luaL_checktype(lua, 1, LUA_TTABLE);
    std::size_t count = 0;
    for (lua_pushnil(lua); lua_next(lua, 1); lua_pop(lua, 1)) ++count;
    Sandbox::spend(lua, as_work(4 * double(count)));
    auto* keys = static_cast<Key*>(lua_newuserdatauv(lua, (count + 1) * sizeof(Key), 0));
    std::size_t filled = 0;
    for (lua_pushnil(lua); lua_next(lua, 1); lua_pop(lua, 1)) {
        Key key{};
        switch (lua_type(lua, -2)) {
            case LUA_TNUMBER:
                key.integer = lua_isinteger(lua, -2);
                key.number = lua_tonumber(lua, -2);
                key.whole = key.integer ? lua_tointeger(lua, -2) : 0;
                break;
            case LUA_TSTRING:
                key.type = 1;
                key.text = lua_tolstring(lua, -2, &key.size);
                break;
            case LUA_TBOOLEAN:
                key.type = 2;
                key.number = lua_toboolean(lua, -2);
                break;
            default:
                return luaL_error(lua, "pairs: expected keys that have an order (numbers, strings), got a %s",
                                  luaL_typename(lua, -2));
        }
        keys[filled++] = key;
    }
    std::sort(keys, keys + filled);
    lua_createtable(lua, int(std::min<std::size_t>(filled, 1 << 30)), 0);
    for (std::size_t i = 0; i < filled; ++i) {
        const Key& key = keys[i];
        if (key.type == 1)
            lua_pushlstring(lua, key.text, key.size);
        else if (key.type == 2)
            lua_pushboolean(lua, key.number != 0);
        else if (key.integer)
            lua_pushinteger(lua, key.whole);
        else
            lua_pushnumber(lua, key.number);
        lua_rawseti(lua, -2, lua_Integer(i) + 1);
    }
    lua_pushinteger(lua, 0);
    lua_pushcclosure(lua, next_pair, 2);
    lua_pushvalue(lua, 1);
    lua_pushnil(lua);
    return 3;
}

void replace(lua_State* lua, const char* name, lua_CFunction function) {
    lua_pushcfunction(lua, function);
    lua_setfield(lua, -2, name);
}

template <class Names>
void remove_names(lua_State* lua, const Names& names) {
    for (const char* name : names) {
        lua_pushnil(lua);
        lua_setfield(lua, -2, name);
    }
}

}  // namespace

void check_plain_table(lua_State* lua, int index) {
    luaL_checktype(lua, index, LUA_TTABLE);
    if (lua_getmetatable(lua, index)) luaL_error(lua, "expected a table without metatable, got one that has it");
}

void open_library(lua_State* lua) {
    luaL_requiref(lua, LUA_TABLIBNAME, luaopen_table, 1);
    wrap(lua, "concat", over_whole_table<4>);
    wrap(lua, "unpack", over_whole_table<3>);
    replace(lua, "sort", sort_table);
    wrap(lua, "move", move_range);
    replace(lua, "insert", insert_into_table);
    replace(lua, "remove", remove_from_table);
    refuse_missing_names(lua, "table.");
    lua_pop(lua, 1);

    luaL_requiref(lua, LUA_STRLIBNAME, luaopen_string, 1);
    remove_names(lua, gone_from_string);
    wrap(lua, "rep", repeat_string);
    wrap(lua, "format", format_text);
    for (const char* name : {"byte", "char", "lower", "pack", "reverse", "unpack", "upper"})
        wrap(lua, name, heeding_time);
    refuse_missing_names(lua, "string.");
    lua_pop(lua, 1);

    luaL_requiref(lua, LUA_MATHLIBNAME, luaopen_math, 1);
    wrap(lua, "randomseed", seed_random);
    for (const char* name : {"max", "min"}) wrap(lua, name, heeding_time);
    lua_getfield(lua, -1, "randomseed");
    lua_call(lua, 0, 0);
    refuse_missing_names(lua, "math.");
    lua_pop(lua, 1);

    luaL_requiref(lua, LUA_COLIBNAME, luaopen_coroutine, 1);
    for (const char* name : {"create", "wrap"}) wrap(lua, name, create_coroutine);
    refuse_missing_names(lua, "coroutine.");
    lua_pop(lua, 1);

    luaL_requiref(lua, LUA_GNAME, luaopen_base, 1);
    remove_names(lua, gone_from_base);
    wrap(lua, "pairs", pairs);
    wrap(lua, "setmetatable", set_metatable);
    wrap(lua, "tonumber", heeding_time);
    replace(lua, "tostring", value_text);
    replace(lua, "print", print_values);
    replace(lua, "rawlen", raw_length);
    refuse_missing_names(lua, "");
    lua_pop(lua, 1);

    open_length(lua);
}

}  // namespace deburr
