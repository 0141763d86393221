// Limits of a scene: time inside C functions, memory that C++ uses for Lua's values, work and output.
#include <chrono>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "raytracer/scene/scene_error_case.hpp"

using namespace deburr;

namespace {

constexpr std::int64_t endless = std::numeric_limits<std::int64_t>::max() / 2;

// Nested functions with so many locals that parsing each use of a global searches all of their names.
std::string slow_to_parse() {
    std::string text;
    for (int depth = 0; depth < 150; ++depth) {
        for (int i = 0; i < 190; ++i) text += "local a" + std::to_string(depth) + "_" + std::to_string(i) + " ";
        text += "local function f() ";
    }
    for (int i = 0; i < 2'000'000; ++i) text += "g();";
    for (int depth = 0; depth < 150; ++depth) text += " end";
    return text;
}

}  // namespace

TEST_CASE("time is up within a second of the limit, though no hook is called", "[slow]") {
    const std::string digits = "local s = ('1'):rep(2^20) ", long_digits = "local s = ('1'):rep(2^23) ";
    const std::string twins = "local a, b = ('a'):rep(2^23), ('a'):rep(2^23) ";
    const std::vector<std::string> texts = {
        "local s, t = ('a'):rep(2^24), {} for i = 1, 1e5 do t[i] = s end table.sort(t)",
        twins + "local t = {} for i = 1, 1e5 do t[i] = {} end table.sort(t, function() return a < b end)",
        digits + "while true do local _ = tonumber(s) end",
        digits + "while true do local _ = s + 1 end",
        "local s = ('0'):rep(2^20) .. '1' while true do local _ = -s end",
        digits + "while true do local _ = math.sin(s) end",
        digits + "local t = {} for i = 1, 200 do t[i] = s end while true do math.max(table.unpack(t)) end",
        digits +
            "local t = {} for i = 1, 200 do t[i] = s end while true do string.format(('%g'):rep(200), table.unpack(t)) "
            "end",
        digits +
            "local t = {} for i = 1, 200 do t[i] = s end while true do string.pack(('n'):rep(200), table.unpack(t)) "
            "end",
        "local f = (' '):rep(2^24) while true do string.pack(f) end",
        "local f, s = ('b'):rep(2^16), ('a'):rep(2^16) while true do string.unpack(f, s) end",
        "local f = ('%%'):rep(2^16) while true do local _ = string.format(f) end",
        "local s = ('a'):rep(2^24) while true do local _ = s:upper() end",
        "local s = ('a'):rep(2^24) while true do local _ = s:reverse() end",
        "local s = ('a'):rep(2^17) while true do local _ = s:byte(1, -1) end",
        twins + "while true do local _ = a < b end",
        twins + "while true do local _ = a == b end",
        twins + "local t = {[a] = 1} while true do local _ = t[b] end",
        twins + "local m = setmetatable({}, {__lt = function() return a < b end}) while true do local _ = m < m end",
        twins + "while true do pcall(function() return a <= b end) end",
        twins + "while true do local c = coroutine.wrap(function() coroutine.yield(a < b) end) c() end",
        twins +
            "local c = {} for i = 1, 1e4 do c[i] = coroutine.create(function() while true do local _ = a < b "
            "coroutine.yield() end end) end while true do for i = 1, 1e4 do coroutine.resume(c[i]) end end",
        "local t = {} for i = 1, 5e5 do t[i] = i end while true do select('#', table.unpack(t, 2, 5e5)) end",
        "local t = {} for i = 2, 1e6 do t[i] = '' end while true do table.concat(t, '', 2, 1e6) end",
        "local t = {} for i = 1, 1e6 do t[i] = i end while true do table.move(t, 1, 1e6, 2) end",
        "local t = {} for i = 1, 1e5 do t[i] = i end while true do for _ in pairs(t) do break end end",
        "while true do pcall(error, setmetatable({}, {__tostring = error})) end",
        "local x <close> = setmetatable({}, {__close = function() while true do end end})",
        "while true do xpcall(error, function() while true do end end) end",
        "local p = {} for i = 1, 4000 do p[i] = {i % 7, i % 11, i % 13} end while true do pcall(convex, p) end",
        slow_to_parse()};
    const std::string text = GENERATE_COPY(from_range(texts));
    CAPTURE(text.substr(0, 300));
    const auto start = std::chrono::steady_clock::now();
    const std::string error = error_within(text, {std::size_t(256) << 20, endless, 0.5});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK_THAT(error, Catch::Matchers::StartsWith("s.lua:"));
    CHECK_THAT(error, Catch::Matchers::EndsWith("expected a scene that is ready within 0.5 s, got one that is not"));
    CHECK(seconds.count() < 1.5 * test::slowness);
}

TEST_CASE("a run that was left behind changes nothing of the next one") {
    const std::string scene = "local r = param('r', 0.5) return { solids = { rounded(r, cube()) } }";
    for (int i = 0; i < 5; ++i) {
        error_within("local a, b = ('a'):rep(2^23), ('a'):rep(2^23) while true do local _ = a < b cube() print(1) end",
                     {std::size_t(256) << 20, endless, 0.05});
        CHECK(error_within(scene, {}, {{"r", "0.25"}}) == "no error");
    }
}

TEST_CASE("what C++ makes of a scene's values counts as the scene's memory") {
    const std::string text_of_4_mib = "local s = ('a'):rep(2^22) ";
    const std::vector<std::string> texts = {
        text_of_4_mib + "local t = {} for i = 1, 100 do t[i] = s end box(t, {1, 1, 1})",
        text_of_4_mib + "local t = {} for i = 1, 100 do t[i] = s end box(table.unpack(t))",
        text_of_4_mib + "local t = {} for i = 1, 100 do t['k' .. i] = s end matte(t)",
        text_of_4_mib + "local t = {} for i = 1, 12 do t = {[s] = t} end matte(t)",
        text_of_4_mib + "local t = {} for i = 1, 100 do t[i] = s end return { solids = t }",
        text_of_4_mib + "while true do cube():name(s) end",
        text_of_4_mib + "local i = 0 while true do i = i + 1 param(i .. s, 1) end",
        text_of_4_mib + "local i = 0 while true do i = i + 1 param('p' .. i, s) end",
        text_of_4_mib + "local b, t = cube():name(s), {} for i = 1, 100 do t[i] = b end return { solids = t }",
        "local t = {} for i = 1, 1000 do t[i] = 0 end for k = 1, 5 do local u = {} for i = 1, 1000 do u[i] = t end\n"
        "t = u end matte(t)",
        "local p = {} for i = 1, 1e5 do local a = i * 2.4 local z = 1 - i / 5e4 local s = math.sqrt(1 - z * z)\n"
        "p[i] = {s * math.cos(a), s * math.sin(a), z} end convex(p)"};
    const std::string text = GENERATE_COPY(from_range(texts));
    CAPTURE(text);
    CHECK_THAT(error_within(text, {std::size_t(64) << 20, endless, 20.0}),
               Catch::Matchers::EndsWith("expected a scene that needs at most 64 MiB, got one that needs more"));
}

TEST_CASE("memory for a call comes back when it ends, so that many calls need no more than one") {
    CHECK(error_within("local t = {} for i = 1, 1e4 do t[i] = {i, i % 7, i % 11} end\n"
                       "for i = 1, 50 do pcall(cube, t) end return { solids = { cube() } }",
                       {std::size_t(16) << 20, endless, 20.0}) == "no error");
}

TEST_CASE("an object's name is one text, however often the object is placed") {
    CHECK(error_within("local b = cube():name(('n'):rep(2^20)) for i = 1, 1e4 do b = b:translate(0, 0, 1) end\n"
                       "return { solids = { b } }",
                       {std::size_t(16) << 20, endless, 20.0}) == "no error");
}

TEST_CASE(
    "a scene's parts are bounded in memory, and a million blocks, each turned, scaled and moved, are within the "
    "bounds") {
    SandboxLimits limits;
    limits.parts /= 100;  // so the limit is 10,000
    limits.work /= 100;
    CHECK(error_within("local b, s = sharp(halfspace({1, 0, 0}, 0)), {} for i = 1, 1e4 do\n"
                       "s[i] = b:rotate(i, {0, 1, 0}):scale(2):translate(i, 0, 0) end return { solids = s }",
                       limits) == "no error");
    for (const std::string made :
         {"cube()", "matte{}", "perturbation(1, ellipsoid{})", "~c", "c:translate(1, 2, 3)", "c | c"})
        CHECK_THAT(
            error_within("local c = cube() while true do local _ = " + made + " end", limits),
            Catch::Matchers::EndsWith("expected a scene whose parts take at most 6 MiB, got one whose take more"));
}

TEST_CASE("work is charged before it is done") {
    const auto start = std::chrono::steady_clock::now();
    CHECK(error_within("local q, t = perturbation(1, ellipsoid{}), {} for i = 1, 1e5 do t[i] = q end\n"
                       "freeform(ellipsoid{}, t)",
                       {}) ==
          "s.lua:2: expected a scene that ends within 500000000 instructions, got one that does not");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(seconds.count() < 1 * test::slowness);
}

TEST_CASE("a call that fails costs work, too") {
    const auto start = std::chrono::steady_clock::now();
    CHECK(error_within("while true do pcall(cube, 1) end", {std::size_t(256) << 20, 20'000'000, 20.0}) ==
          "s.lua:1: expected a scene that ends within 20000000 instructions, got one that does not");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(seconds.count() < 2 * test::slowness);
}

TEST_CASE("print is metered, also under pcall") {
    const SandboxLimits limits{std::size_t(16) << 20, 30'000'000, 20.0, 0, std::size_t(16) << 20};
    for (const std::string text : {"print('x')", "while true do pcall(print) end", "print(('a'):rep(2^20))"})
        CHECK(error_within(text, limits) ==
              "s.lua:1: expected a scene that prints at most 0 bytes, got one that prints more");
}
