// The part of Lua's library that a scene may use: base, math, string, table and coroutine, without functions that read
// files, load code, cannot be interrupted, or give different results from run to run.
//
//   removed  load* dofile require collectgarbage warn next, string.dump, and string.find match
//            gmatch gsub (matching backtracks in C, where the budget cannot stop it)
//   changed  pairs visits keys in their order; print writes to stderr, escaped and metered;
//            math.random starts from a fixed seed; table.sort draws no pivot from the clock; no text
//            contains an address; setmetatable refuses __gc; # and functions that need a length find
//            a border by the table's content only; functions that loop in C are charged to the
//            budget in advance
//   names    reading an unknown name is an error, and does not give nil
//
// Not promised: when an entry of a weak table is collected. That depends on the memory of tables, and so, where keys
// other than numbers were removed, on the order of their hash and on Lua's seed.
#pragma once

struct lua_State;

namespace deburr {

/// Opens the library in a new state. May raise Lua errors.
void open_library(lua_State* lua);

}  // namespace deburr
