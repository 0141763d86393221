// Functions of Lua's library that a scene gets in our own version, because Lua's lets a clock or an address into the
// result, or does not come back. Each is a lua_CFunction and may raise Lua errors.
#pragma once

struct lua_State;

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

/// Raises unless the value at `index` is a table without a metatable: functions of tables believe a __len, and would
/// loop that often.
void check_plain_table(lua_State* lua, int index);

}  // namespace deburr
