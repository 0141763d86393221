// What a scene may use of Lua's own library: base, math, string, table and coroutine, without
// whatever reads files, loads code, cannot be interrupted, or gives different results on every run.
//
//   gone     load* dofile require collectgarbage warn next, string.dump, and string.find match
//            gmatch gsub (matching backtracks in C, out of reach of the budget)
//   changed  pairs walks in the order of the keys, print writes to stderr, math.random starts from
//            one seed, setmetatable refuses __gc; what loops in C is charged to the budget
//   names    one that is not there is an error where it is read, not nil
#pragma once

struct lua_State;

namespace deburr {

/// May raise Lua errors.
void open_library(lua_State* lua);

}  // namespace deburr
