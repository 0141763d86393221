// Functions of Lua's library that a scene gets in our own version, because Lua's lets a clock or an address into the
// result, or does not come back. Each is a lua_CFunction and may raise Lua errors.
#pragma once
#include <lua.hpp>
#include <string>
#include <string_view>

namespace deburr {

/// table.sort(t [, before]): by introspection of the table alone, so that equal items end in the same order on every
/// run. (Lua draws pivots from the clock once a large partition is uneven.)
int sort_table(lua_State* lua);

/// tostring(v), where tables, functions and coroutines are "table", "function", "thread" without an address.
int value_text(lua_State* lua);

/// string.format, with texts of values as value_text makes them, and without %p. Upvalue: Lua's own.
int format_text(lua_State* lua);

/// print(…): one line on stderr, escaped and metered.
int print_values(lua_State* lua);

/// The length of the table at the absolute index `table`: a border that depends on the table's content alone.
lua_Integer border(lua_State* lua, int table);

/// The same program, where # finds a border by content once open_length() was called. # cannot be given another meaning
/// for tables without metatable; so it becomes a power of false, which binds as # does wherever that may stand.
std::string with_length_by_content(std::string_view text);
void open_length(lua_State* lua);

/// rawlen, table.insert, table.remove.
int raw_length(lua_State* lua);
int insert_into_table(lua_State* lua);
int remove_from_table(lua_State* lua);

/// Raises unless the value at `index` is a table without a metatable: functions of tables believe a __len, and would
/// loop that often.
void check_plain_table(lua_State* lua, int index);

}  // namespace deburr
