// The sandbox that runs scenes: limits of time and memory, errors, and the functions that it offers.
#include <chrono>

#include "catch.hpp"
#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/sandbox_result.hpp"

using namespace deburr;

namespace {

const SandboxLimits small{std::size_t(16) << 20, 3'000'000, 20.0};

std::string small_result(const std::string& text) { return result_of(text, small); }

struct SandboxCase {
    const char *text, *result;
};

}  // namespace

TEST_CASE("a run that spends its budget ends, whatever it tries") {
    // Each of these once survived an error raised by the hook, or would have looped where no hook is called.
    const std::string text =
        GENERATE("while true do end", "pcall(function() while true do end end) while true do end",
                 "while true do pcall(function() while true do end end) end",
                 "coroutine.wrap(function() while true do end end)()",
                 "local c = coroutine.create(function()\n"
                 "  local x <close> = setmetatable({}, {__close = function() while true do end end})\n"
                 "  while true do end\n"
                 "end)\n"
                 "coroutine.resume(c) coroutine.close(c)",
                 "local x <close> = setmetatable({}, {__close = function() while true do end end})",
                 "local function f(d) for i = 1, 150 do coroutine.wrap(function()\n"
                 "  if d > 0 then f(d - 1) end end)() end end f(190)",
                 "local t = setmetatable({}, {__index = function(t, k) while true do end end}) return t.x",
                 "local t = setmetatable({}, {__tostring = function() while true do end end}) print(t)",
                 "while true do pcall(error, setmetatable({}, {__tostring = error})) end",
                 "table.sort({3, 2, 1}, function() while true do end end)", "table.move({}, 1, 1 << 60, 2)",
                 "for k in pairs({1}) do while true do end end", "goto on ::on:: goto on");
    CAPTURE(text);
    const auto start = std::chrono::steady_clock::now();
    CHECK_THAT(small_result(text), Catch::Matchers::EndsWith("expected a scene that ends within 3000000 "
                                                             "instructions, got one that does not"));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(seconds.count() < 2 * test::slowness);
}

TEST_CASE("a run ends by the clock where the budget is large") {
    CHECK(result_of("\nwhile true do end", {std::size_t(16) << 20, 1'000'000'000'000, 0.05}) ==
          "s.lua:2: expected a scene that is ready within 0.05 s, got one that is not");
}

TEST_CASE("a run that needs more memory than it may have ends") {
    const std::string text =
        GENERATE("local t = {} for i = 1, 1e9 do t[i] = i end", "local s = 'x' while true do s = s .. s end",
                 "while true do pcall(function() local t = {} for i = 1, 1e9 do t[i] = i end end) end",
                 "local s = ('x'):rep(1 << 20) local t = {} for i = 1, 100 do t[i] = s end table.concat(t)",
                 "string.pack('c2000000000', '')", "string.format('%s', ('xxxxxxxx'):rep(1 << 20):rep(2))");
    CAPTURE(text);
    CHECK_THAT(small_result(text),
               Catch::Matchers::EndsWith("expected a scene that needs at most 16 MiB, got one that needs more"));
}

TEST_CASE("what is wrong in a chunk is one line with file and line") {
    const SandboxCase c = GENERATE(values<SandboxCase>({
        {"local x = = 1", "s.lua:1: unexpected symbol near '='"},
        {"\n\nerror('stop')", "s.lua:3: stop"},
        {"error('a\\nb\\0c')", R"(s.lua:1: a\nb\x00c)"},
        {"error({})", "s.lua:1: expected an error with a message, got one with a table value"},
        {"error()", "s.lua:1: expected an error with a message, got one with a nil value"},
        {"error(42)", "s.lua:1: 42"},
        {"\nerror('stop', 0)", "s.lua:2: stop"},
        {"\ntable.sort({1, {}})", "s.lua:2: attempt to compare"},
        {"\nlocal a = nil + 1", "s.lua:2: attempt to perform arithmetic on a nil value"},
        {"local function f() return 1 + f() end f()", "s.lua:1: stack overflow"},
        {"setmetatable({}, {__gc = print})",
         "s.lua:1: setmetatable: expected no __gc, which is not available in a scene"},
        {"\nreturn ('x'):rep(1 << 33)", "s.lua:2: string.rep: expected a result of at most 16777216 bytes, got more"},
        {"('').rep('', 1 << 60)", "s.lua:1: string.rep: expected a result of at most 16777216 bytes, got more"},
        {"table.sort({3, 2, 1, 4, 5, 6}, function() return true end)", "s.lua:1: invalid order function for sorting"},
        {"table.insert(setmetatable({}, {__len = function() return 1 << 60 end}), 1, 2)",
         "s.lua:1: expected a table without metatable, got one that has it"},
        {"table.insert({}, 1, 2, 3)", "s.lua:1: wrong number of arguments to 'insert'"},
        {"for k in pairs({[{}] = 1}) do end",
         "s.lua:1: pairs: expected keys that have an order (numbers, strings), got a table"},
        {"local f = pairs({1})\nf(2)", "s.lua:2: bad argument #1 to 'f' (table expected, got number)"},
        {"local a <close> = 1", "s.lua:1: variable 'a' got a non-closable value"},
    }));
    CAPTURE(c.text);
    const std::string error = result_of(c.text, {std::size_t(256) << 20, 30'000'000, 20.0});
    CHECK_THAT(error, Catch::Matchers::StartsWith(c.result));
    CHECK(error.find('\n') == std::string::npos);
}

TEST_CASE("what a scene may not use says so, and unknown names are errors") {
    for (const std::string name :
         {"io", "os", "package", "debug", "require", "load", "loadfile", "loadstring", "dofile", "collectgarbage",
          "next", "string.find", "string.match", "string.gmatch", "string.gsub", "string.dump"}) {
        CAPTURE(name);
        CHECK_THAT(small_result("local x = " + name),
                   Catch::Matchers::StartsWith("s.lua:1: " + name + ": not available in a scene"));
    }
    CHECK(small_result("\n('a'):find('a')") == "s.lua:2: string.find: not available in a scene");
    CHECK(small_result("local x = plastik") == "s.lua:1: expected a known name, got 'plastik'");
    CHECK(small_result("return math.flor(1)") ==
          "s.lua:1: expected a known name, got 'math.flor', did you mean math.floor?");
    CHECK(small_result("return prind") == "s.lua:1: expected a known name, got 'prind', did you mean print?");
    CHECK(small_result("for i = 1, 3000 do _G['name' .. i] = i end return prind") ==
          "s.lua:1: expected a known name, got 'prind'");
    CHECK(small_result("return math.cosine(1)") == "s.lua:1: expected a known name, got 'math.cosine'");
    CHECK(small_result("x = 1 return x") == "1");
    CHECK(small_result("return getmetatable(_G)") == "false");
}

TEST_CASE("bytecode is refused") {
    CHECK_THAT(small_result("\x1bLua"), Catch::Matchers::StartsWith("s.lua: attempt to load a binary chunk"));
}

TEST_CASE("runs are reproducible: random numbers and the order of pairs") {
    const std::string random = "return math.random() .. ' ' .. math.random(100)";
    CHECK(small_result(random) == small_result(random));
    CHECK(small_result("math.randomseed() " + random) == small_result(random));
    CHECK(small_result("math.randomseed(5) " + random) != small_result(random));
    CHECK(small_result("local s = '' local t = {z = 1, a = 2, [10] = 3, [2] = 4, [0.5] = 5, [true] = "
                       "6, aa = 7}\n"
                       "for k, v in pairs(t) do s = s .. tostring(k) .. v .. ' ' end return s") ==
          "0.55 24 103 a2 aa7 z1 true6 ");
    CHECK(small_result("local s = '' local t = {a = 1, b = 2, c = 3}\n"
                       "for k in pairs(t) do t.b = nil s = s .. k end return s") == "ac");
    CHECK(small_result("local s = '' for k, v in pairs(setmetatable({}, {__pairs = function() return\n"
                       "function(_, k) if not k then return 'x', 1 end end end})) do s = s .. k end "
                       "return s") == "x");
}

TEST_CASE("the rest of the library is there") {
    CHECK(small_result("local t = {3, 1, 2} table.sort(t) table.insert(t, 4) table.insert(t, 1, 0)\n"
                       "return table.concat(t, ',') .. table.remove(t) .. table.remove(t, 1) .. #t") == "0,1,2,3,4403");
    CHECK(small_result("local co = coroutine.wrap(function(a) local b = coroutine.yield(a + 1) return "
                       "b * 2 end)\n"
                       "co(1) return co(21)") == "42");
    CHECK(small_result("local ok, e = pcall(error, 'x') return e") == "x");
    CHECK(small_result("local ok, e = xpcall(error, function(m) return m .. '!' end, 'x') return e") == "x!");
    CHECK(small_result("return string.format('%d %s', 3, ('ab'):upper():rep(2, '-')) .. ('x'):byte()") == "3 AB-AB120");
    CHECK(small_result("return select('#', table.unpack({1, 2, 3}))") == "3");
}
