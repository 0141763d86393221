// A scene gives the same bytes on every run: it sees neither clocks nor addresses.
#include <set>

#include "catch.hpp"
#include "raytracer/scene/sandbox_result.hpp"

using namespace deburr;

TEST_CASE("no text of a value holds an address") {
    CHECK(result_of("return tostring({}) .. ' ' .. tostring(print) .. ' ' .. tostring(function() end) .. ' ' ..\n"
                    "tostring(coroutine.create(print))") == "table function function thread");
    CHECK(result_of("return string.format('%s|%10s|%-9s|%.3s', {}, print, {}, print)") ==
          "table|  function|table    |fun");
    CHECK(result_of("return ('%d%%%s %5.1f'):format(3, nil, 2.25)") == "3%nil   2.2");
    CHECK(result_of("return tostring(setmetatable({}, {__name = 'Wheel'}))") == "Wheel");
    CHECK(result_of("return tostring(setmetatable({}, {__name = 3}))") == "table");
    CHECK(result_of("return tostring(setmetatable({}, {__tostring = function() return 'own' end}))") == "own");
    CHECK(result_of("return string.format('%s', setmetatable({}, {__tostring = function() return 'own' end}))") ==
          "own");
    CHECK(result_of("return tostring(setmetatable({}, {__tostring = function() return {} end}))") ==
          "s.lua:1: '__tostring' must return a string");
    CHECK(result_of("return tostring(1.5) .. tostring(7) .. tostring(nil) .. tostring(true)") == "1.57niltrue");
    CHECK(result_of("tostring()") == "s.lua:1: bad argument #1 to 'tostring' (value expected)");
    for (const std::string format : {"%p", "%5p", "%-20p", "a%%%p", "%s%p"})
        CHECK_THAT(result_of("return string.format('" + format + "', {}, {})"),
                   Catch::Matchers::StartsWith("s.lua:1: string.format: %p is not available in a scene"));
    CHECK(result_of("return string.format('%')") == "s.lua:1: bad argument #2 to 'format' (no value)");
    CHECK(result_of("string.format('%d', {})") == "s.lua:1: bad argument #2 to 'format' (number expected, got table)");
}

TEST_CASE("ties come out of table.sort in the same order on every run") {
    // With many equal items and few extreme ones the partitions are uneven, which makes Lua's own sort ask the clock.
    const std::string text =
        "local n, t = 20000, {}\n"
        "for i = 1, n do t[i] = {10 + i % 7, i} end\n"
        "t[1][1] = 0 t[5000][1] = 1 t[n][1] = 2\n"
        "table.sort(t, function(a, b) return a[1] < b[1] end)\n"
        "local h = 0 for i = 1, n do h = (h * 31 + t[i][2]) % 1000000007 end\n"
        "for i = 2, n do assert(t[i - 1][1] <= t[i][1]) end\n"
        "return '' .. h";
    const std::string first = result_of(text);
    CHECK(first == "52402346");
    for (int i = 0; i < 3; ++i) CHECK(result_of(text) == first);
}

TEST_CASE("how long a table with holes is does not depend on the order of its hash") {
    // Lua measures the table's array anew or not, depending on whether an added key hashes to the slot of a removed
    // one.
    const std::string before =
        "local t = {1, 2, 3, 4}\n"
        "for j = 1, 8 do t['a' .. k .. j] = 1 end for j = 1, 8 do t['a' .. k .. j] = nil end\n"
        "t[2], t[3] = nil, nil for j = 1, 3 do t['b' .. k .. j] = 1 end\n";
    for (const std::string length : {"#t", "rawlen(t)", "select('#', table.unpack(t))", "#table.concat(t)",
                                     "(table.insert(t, 9) or t[2])", "table.remove(t)", "(table.sort(t) or t[1])"}) {
        CAPTURE(length);
        const std::string all = result_of("local all = {} for k = 1, 200 do " + before + "all[k] = '' .. " + length +
                                          " end return table.concat(all)");
        REQUIRE(all.size() == 200);
        CHECK(all == std::string(200, all[0]));
    }
}

TEST_CASE("a length binds as Lua's # does, and stands wherever that may") {
    const std::pair<std::string, std::string> table[] = {
        {"'' .. #'abc'", "3"},
        {"'' .. #{1, 2, 3} * 2", "6"},
        {"'' .. 2 ^ #{1, 2, 3}", "8.0"},
        {"'' .. 2 * #'ab' ^ 2", "attempt"},
        {"'' .. -#'ab' .. #'cde'", "-23"},
        {"tostring(not #'')", "false"},
        {"'' .. ##{1, 2}", "attempt"},
        {"'' .. #t.x[1]", "5"},
        {"'' .. #t:f()", "4"},
        {"'' .. #(t.x)", "1"},
        {"t[#t.x + 1]", "one more"},
        {"'#' .. [[#]] .. [==[#]]#]==] .. \"\\\"#\" .. '\\'#'", "###]]#\"#'#"},
        {"'' .. #t.x --[[ # ]] + 1 -- #", "2"},
        {"'' .. #t.x --[==[ # ]] ]==] + 1", "2"},
        {"'' .. #setmetatable({}, {__len = function() return 7 end, __pow = 1})", "7"},
        {"'' .. rawlen(setmetatable({2}, {__len = function() return 7 end}))", "1"},
        {"'' .. #{n = 1}", "0"},
        {"'' .. #5", "attempt to get length of a number value"},
        {"'' .. #t.none", "attempt to get length of a nil value"},
        {"'' .. true ^ 2", "attempt to perform arithmetic on a boolean value"},
        {"'' .. 2 ^ false", "attempt to perform arithmetic on a boolean value"},
    };
    for (const auto& [expression, expected] : table) {
        CAPTURE(expression);
        const std::string result = result_of(
            "local t = {x = {'hello'}, f = function() return 'four' end}\n"
            "t[2] = 'one more'\nreturn(" +
            expression + "\n)");
        if (expected.rfind("attempt", 0) == 0)
            CHECK_THAT(result, Catch::Matchers::StartsWith("s.lua:3: " + expected));
        else
            CHECK(result == expected);
    }
    CHECK(result_of("local t = {5, 6} return#t == 2 and'yes'or'no'") == "yes");
    for (const int n : {0, 1, 2, 3, 4, 5, 7, 8, 9, 100, 1000, 1025})
        CHECK(result_of("local t = {} for i = 1, " + std::to_string(n) + " do t[i] = i end return '' .. #t") ==
              std::to_string(n));
}

TEST_CASE("insert and remove move what is behind") {
    CHECK(result_of("local t = {} for i = 1, 9 do table.insert(t, i) end table.insert(t, 3, 'a')\n"
                    "table.insert(t, 11, 'b') table.remove(t, 1) local last = table.remove(t)\n"
                    "return table.concat(t) .. last .. tostring(table.remove({})) .. tostring(table.remove({}, 0))") ==
          "2a3456789bnilnil");
    for (const char* call :
         {"table.insert({}, 2, 0)", "table.insert({}, 0, 0)", "table.remove({1}, 3)", "table.remove({1}, -1)"})
        CHECK_THAT(result_of(call), Catch::Matchers::EndsWith("position out of bounds)"));
    CHECK(result_of("table.insert({}, 1, 2, 3)") == "s.lua:1: wrong number of arguments to 'insert'");
}

TEST_CASE("table.sort sorts, whatever the order before") {
    for (const std::string item : {"i", "-i", "i % 7", "(i * 7919) % 1009", "math.abs(i - 500)", "-math.abs(i - 500)",
                                   "0", "math.random(100)", "i & -i", "i ~ 341"})
        for (const std::string size : {"0", "1", "2", "3", "4", "10", "99", "100", "101", "102", "1000", "5000"}) {
            CAPTURE(item, size);
            CHECK(result_of("local n, t, count = " + size +
                            ", {}, {}\n"
                            "for i = 1, n do t[i] = " +
                            item +
                            " count[t[i]] = (count[t[i]] or 0) + 1 end\n"
                            "table.sort(t)\n"
                            "for i = 1, n do assert(i == 1 or t[i - 1] <= t[i]) count[t[i]] = count[t[i]] - 1 end\n"
                            "for _, c in pairs(count) do assert(c == 0) end\n"
                            "table.sort(t, function(a, b) return a > b end)\n"
                            "for i = 2, n do assert(t[i - 1] >= t[i]) end return 'sorted'") == "sorted");
        }
    CHECK(result_of("local t = {'b', 'a', 'c'} table.sort(t) return table.concat(t)") == "abc");
    CHECK(result_of("table.sort({2, 1}, 3)") == "s.lua:1: bad argument #2 to 'sort' (function expected, got number)");
    CHECK_THAT(result_of("local t = {} for i = 1, 300 do t[i] = i end table.sort(t, function() return true end)"),
               Catch::Matchers::EndsWith("invalid order function for sorting"));
    CHECK(result_of(
              "local t = {} for i = 1, 300 do t[i] = i end table.sort(t, function() return false end) return 'ends'") ==
          "ends");
}

TEST_CASE("the middle as pivot is the worst for no order that a scene is likely to have") {
    // Organ pipes, whose first, middle and last items are all extreme, are sorted with few comparisons.
    CHECK(result_of("local n, t, c = 100000, {}, 0 for i = 1, n do t[i] = math.min(i, n - i) end\n"
                    "table.sort(t, function(a, b) c = c + 1 return a < b end) return tostring(c < 6000000)") == "true");
}
