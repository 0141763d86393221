// Conversion of values to text: tostring, string.format, print.
#include <cstring>
#include <lua.hpp>

#include "raytracer/scene/lua_replacements.hpp"
#include "raytracer/scene/lua_sandbox.hpp"

namespace deburr {
namespace {

bool is_text(lua_State* lua, int index) {
    return lua_type(lua, index) == LUA_TSTRING || lua_type(lua, index) == LUA_TNUMBER;
}

// A table of at most this many numbers is shown as a list.
constexpr lua_Integer longest_list = 16;

// Pushes "{1, 2, 0.5}" for a table of a few numbers and nothing else; otherwise returns false.
bool push_list(lua_State* lua, int index) {
    const lua_Integer size = border(lua, index);
    if (size == 0 || size > longest_list) return false;
    lua_Integer fields = 0;
    for (lua_pushnil(lua); lua_next(lua, index); lua_pop(lua, 1))
        if (++fields > size || lua_type(lua, -1) != LUA_TNUMBER) {
            lua_pop(lua, 2);
            return false;
        }
    if (fields != size) return false;
    lua_pushliteral(lua, "{");
    for (lua_Integer i = 1; i <= size; ++i) {
        if (i > 1) lua_pushliteral(lua, ", ");
        lua_rawgeti(lua, index, i);
        luaL_tolstring(lua, -1, nullptr);
        lua_remove(lua, -2);
        lua_concat(lua, i > 1 ? 3 : 2);
    }
    lua_pushliteral(lua, "}");
    lua_concat(lua, 2);
    return true;
}

// Pushes the text of the value at `index`.
void push_text(lua_State* lua, int index) {
    index = lua_absindex(lua, index);
    if (luaL_callmeta(lua, index, "__tostring")) {
        if (!lua_isstring(lua, -1)) luaL_error(lua, "'__tostring' must return a string");
        lua_tostring(lua, -1);  // turns a number into text
        return;
    }
    switch (lua_type(lua, index)) {
        case LUA_TNIL:
        case LUA_TBOOLEAN:
        case LUA_TNUMBER:
        case LUA_TSTRING: luaL_tolstring(lua, index, nullptr); return;
        default: {
            // Lua's own text would continue with the address.
            const int name = luaL_getmetafield(lua, index, "__name");
            if (name == LUA_TSTRING) return;
            if (name != LUA_TNIL) lua_pop(lua, 1);
            if (lua_type(lua, index) == LUA_TTABLE && !lua_getmetatable(lua, index) && push_list(lua, index)) return;
            lua_pushstring(lua, luaL_typename(lua, index));
        }
    }
}

}  // namespace

int value_text(lua_State* lua) {
    luaL_checkany(lua, 1);
    push_text(lua, 1);
    return 1;
}

int format_text(lua_State* lua) {
    std::size_t size = 0;
    const char* format = luaL_checklstring(lua, 1, &size);
    const char* const end = format + size;
    const int last = lua_gettop(lua);
    int argument = 1;
    Sandbox::spend(lua, std::int64_t(size / 4));
    while (const auto* percent = static_cast<const char*>(std::memchr(format, '%', std::size_t(end - format)))) {
        format = percent + 1;
        while (format < end && *format && std::strchr("-+#0 123456789.", *format)) ++format;
        if (format == end) break;
        const char conversion = *format++;
        if (conversion == '%') continue;
        if (conversion == 'p')
            return luaL_error(lua, "string.format: %%p is not available in a scene, addresses differ from run to run");
        if (++argument > last || conversion != 's' || is_text(lua, argument)) continue;
        push_text(lua, argument);
        lua_replace(lua, argument);
    }
    return lua_tocfunction(lua, lua_upvalueindex(1))(lua);
}

int print_values(lua_State* lua) {
    const int last = lua_gettop(lua);
    for (int i = 1; i <= last; ++i) {
        push_text(lua, i);
        lua_replace(lua, i);
    }
    Sandbox::print(lua, 1, last);
    return 0;
}

}  // namespace deburr
