// The length of a table, which does not depend on how Lua stores it: # and the functions that ask for a length.
//
// In a table with holes, Lua's # is some border: a number n with an item at n and none at n + 1. Which border depends
// on how much of the table Lua keeps as an array; that is determined anew when its hash part is full, which depends on
// whether added keys collided with removed ones; and strings are hashed with a seed that Lua takes from the clock and
// from addresses. Here the border is determined by the table's content only.
#include <algorithm>
#include <lua.hpp>

#include "raytracer/scene/lua_replacements.hpp"
#include "raytracer/scene/lua_sandbox.hpp"

namespace deburr {
namespace {

bool has_item(lua_State* lua, int table, lua_Integer at) {
    const bool has = lua_rawgeti(lua, table, at) != LUA_TNIL;
    lua_pop(lua, 1);
    return has;
}

// The end of a comment, a string or a long string that begins at `at`, in which # is not an operator; `at` if none
// does.
std::size_t skipped(std::string_view text, std::size_t at) {
    const auto long_end = [&](std::size_t from) {  // the end of [==[ … ]==], or `from`
        std::size_t level = from + 1;
        while (level < text.size() && text[level] == '=') ++level;
        if (from >= text.size() || text[from] != '[' || level >= text.size() || text[level] != '[') return from;
        std::string close(level - from + 1, '=');
        close.front() = close.back() = ']';
        const std::size_t end = text.find(close, level);
        return end == std::string_view::npos ? text.size() : end + close.size();
    };
    if (text.substr(at, 2) == "--") {
        const std::size_t end = long_end(at + 2);
        return end > at + 2 ? end : std::min(text.find_first_of("\r\n", at), text.size());
    }
    if (text[at] == '[') return long_end(at);
    if (text[at] != '"' && text[at] != '\'') return at;
    std::size_t end = at + 1;
    for (; end < text.size() && text[end] != text[at]; ++end)
        if (text[end] == '\\') ++end;
    return std::min(end + 1, text.size());
}

// The metamethod __pow of booleans.
int length_or_power(lua_State* lua) {
    if (!lua_isboolean(lua, 1) || lua_toboolean(lua, 1))
        return luaL_error(lua, "attempt to perform arithmetic on a boolean value");
    if (lua_type(lua, 2) == LUA_TSTRING)
        lua_pushinteger(lua, lua_Integer(lua_rawlen(lua, 2)));
    else if (luaL_callmeta(lua, 2, "__len"))
        return 1;
    else if (lua_istable(lua, 2))
        lua_pushinteger(lua, border(lua, 2));
    else
        return luaL_error(lua, "attempt to get length of a %s value", luaL_typename(lua, 2));
    return 1;
}

}  // namespace

lua_Integer border(lua_State* lua, int table) {
    // Doubles until there is no item, then halves between.
    lua_Integer something = 0, nothing = 1;
    std::int64_t looks = 0;
    for (; has_item(lua, table, nothing); ++looks) {
        something = nothing;
        nothing *= 2;
    }
    for (; nothing - something > 1; ++looks) {
        const lua_Integer middle = something + (nothing - something) / 2;
        (has_item(lua, table, middle) ? something : nothing) = middle;
    }
    Sandbox::spend(lua, looks);
    return something;
}

std::string with_length_by_content(std::string_view text) {
    std::string changed;
    changed.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = skipped(text, at);
        if (end > at)
            changed += text.substr(at, end - at);
        else if (text[at] == '#')
            changed += " false^";
        else
            changed += text[at];
        at = std::max(end, at + 1);
    }
    return changed;
}

void open_length(lua_State* lua) {
    lua_pushboolean(lua, 0);
    lua_createtable(lua, 0, 2);
    lua_pushcfunction(lua, length_or_power);
    lua_setfield(lua, -2, "__pow");
    lua_pushboolean(lua, 0);
    lua_setfield(lua, -2, "__metatable");
    lua_setmetatable(lua, -2);
    lua_pop(lua, 1);
}

int raw_length(lua_State* lua) {
    if (lua_type(lua, 1) == LUA_TSTRING)
        lua_pushinteger(lua, lua_Integer(lua_rawlen(lua, 1)));
    else if (lua_istable(lua, 1))
        lua_pushinteger(lua, border(lua, 1));
    else
        return luaL_argerror(lua, 1, "table or string expected");
    return 1;
}

int insert_into_table(lua_State* lua) {
    check_plain_table(lua, 1);
    const lua_Integer end = border(lua, 1) + 1;
    const int count = lua_gettop(lua);
    if (count != 2 && count != 3) return luaL_error(lua, "wrong number of arguments to 'insert'");
    lua_Integer location = end;
    if (count == 3) {
        location = luaL_checkinteger(lua, 2);
        luaL_argcheck(lua, location >= 1 && location <= end, 2, "position out of bounds");
        Sandbox::spend(lua, end - location);
        for (lua_Integer i = end; i > location; --i) {
            lua_rawgeti(lua, 1, i - 1);
            lua_rawseti(lua, 1, i);
        }
    }
    lua_rawseti(lua, 1, location);
    return 0;
}

int remove_from_table(lua_State* lua) {
    check_plain_table(lua, 1);
    const lua_Integer size = border(lua, 1);
    lua_Integer location = luaL_optinteger(lua, 2, size);
    if (lua_gettop(lua) > 1)
        luaL_argcheck(lua, (location >= 1 && location <= size + 1) || location == size, 2, "position out of bounds");
    lua_rawgeti(lua, 1, location);
    Sandbox::spend(lua, size - std::min(location, size));
    for (; location < size; ++location) {
        lua_rawgeti(lua, 1, location + 1);
        lua_rawseti(lua, 1, location);
    }
    lua_pushnil(lua);
    lua_rawseti(lua, 1, location);
    return 1;
}

}  // namespace deburr
