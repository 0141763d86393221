// Replacements for functions of Lua's library whose own version lets a clock or an address into the result, or may not
// return. Each is a lua_CFunction and may raise Lua errors.
#pragma once
#include <lua.hpp>
#include <string>
#include <string_view>

namespace deburr {

/// table.sort(t [, before]) whose choices depend on the table only, so that equal items end in the same order on every
/// run. (Lua draws pivots from the clock once a large partition is uneven.)
int sort_table(lua_State* lua);

/// tostring(v), which writes tables, functions and coroutines as "table", "function" and "thread" without an address.
int value_text(lua_State* lua);

/// string.format that converts values by value_text() and has no %p. Its upvalue is Lua's own string.format.
int format_text(lua_State* lua);

/// print(…), which writes one line to stderr, escaped and charged to the budget of output.
int print_values(lua_State* lua);

/// The length of the table at the absolute index `table`: a border that depends on the table's content only.
lua_Integer border(lua_State* lua, int table);

/// The program with every # replaced, so that it finds a border by content once open_length() was called. As # cannot
/// be redefined for tables without a metatable, it is replaced by a power of false, which has the same precedence and
/// is allowed wherever # is.
std::string with_length_by_content(std::string_view text);
void open_length(lua_State* lua);

/// The functions rawlen, table.insert and table.remove, with border() as length.
int raw_length(lua_State* lua);
int insert_into_table(lua_State* lua);
int remove_from_table(lua_State* lua);

/// Raises an error unless the value at `index` is a table without a metatable: Lua's functions of tables trust a __len,
/// and would loop that often.
void check_plain_table(lua_State* lua, int index);

}  // namespace deburr
