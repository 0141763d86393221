// The part of Lua's library that a scene may use: base, math, string, table and coroutine, without functions that read
// files, load code, cannot be interrupted, or give different results from run to run.
//
//   gone     load* dofile require collectgarbage warn next, string.dump, and string.find match
//            gmatch gsub (matching backtracks in C, out of reach of the budget)
//   changed  pairs walks in the order of the keys, print writes to stderr, escaped and metered,
//            math.random starts from one seed, table.sort draws no pivot from the clock, no text
//            holds an address, setmetatable refuses __gc; # and what asks for a length find a border
//            by the table's content alone; functions that loop in C are charged to the budget in
//            advance
//   names    one that is not there is an error where it is read, not nil
//
// Not promised: when an entry of a weak table is collected. That depends on the memory of tables, and so, where keys
// other than numbers were removed, on the order of their hash and on Lua's seed.
#pragma once

struct lua_State;

namespace deburr {

/// Opens the library in a new state. May raise Lua errors.
void open_library(lua_State* lua);

}  // namespace deburr
