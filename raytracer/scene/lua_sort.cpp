// table.sort: quicksort with the median of three, which agrees with Lua's own wherever that draws no pivot from the
// clock. So ties and inconsistent order functions give the results that scenes have always got.
#include <cmath>
#include <cstdint>
#include <lua.hpp>

#include "raytracer/scene/lua_replacements.hpp"
#include "raytracer/scene/lua_sandbox.hpp"

namespace deburr {
namespace {

// Ranges larger than this may take their pivot from elsewhere than their middle.
constexpr lua_Integer large_range = 100;
// A range was divided unevenly if one part is this many times shorter than the other.
constexpr lua_Integer uneven = 128;

// Sorts the table at stack index 1 by the order function (or nil) at index 2.
class Sorting {
public:
    explicit Sorting(lua_State* lua) : lua_(lua) {}

    void sort(lua_Integer first, lua_Integer last) {
        while (first < last) {
            order(first, last);
            if (last - first == 1) return;
            const lua_Integer middle = pivot(first, last);
            if (!order(first, middle)) order(middle, last);
            if (last - first == 2) return;
            const lua_Integer cut = partition(first, last, middle);
            const bool left_is_shorter = cut - first < last - cut;
            // The shorter part is sorted recursively, so that calls nest no deeper than the logarithm.
            if (left_is_shorter)
                sort(first, cut - 1);
            else
                sort(cut + 1, last);
            const lua_Integer shorter = left_is_shorter ? cut - first : last - cut;
            (left_is_shorter ? first : last) = left_is_shorter ? cut + 1 : cut - 1;
            if ((last - first) / uneven > shorter) scatter_ = true;
        }
    }

private:
    // Whether the value at stack index a comes before the one at index b.
    bool before(int a, int b) {
        if (lua_isnil(lua_, 2)) {
            Sandbox::spend(lua_, 0);  // texts may be long
            return lua_compare(lua_, a, b, LUA_OPLT) != 0;
        }
        a = lua_absindex(lua_, a);
        b = lua_absindex(lua_, b);
        lua_pushvalue(lua_, 2);
        lua_pushvalue(lua_, a);
        lua_pushvalue(lua_, b);
        lua_call(lua_, 2, 1);
        const bool result = lua_toboolean(lua_, -1) != 0;
        lua_pop(lua_, 1);
        return result;
    }

    // Exchanges items i < k if they are in the wrong order; returns whether they were.
    bool order(lua_Integer i, lua_Integer k) {
        lua_rawgeti(lua_, 1, i);
        lua_rawgeti(lua_, 1, k);
        const bool wrong = before(-1, -2);
        if (wrong) {
            lua_rawseti(lua_, 1, i);
            lua_rawseti(lua_, 1, k);
        } else {
            lua_pop(lua_, 2);
        }
        return wrong;
    }

    void exchange(lua_Integer i, lua_Integer k) {
        lua_rawgeti(lua_, 1, i);
        lua_rawgeti(lua_, 1, k);
        lua_rawseti(lua_, 1, i);
        lua_rawseti(lua_, 1, k);
    }

    // The middle, until a range was divided unevenly; then a place in the two inner quarters, so that no order of items
    // is likely to be the worst case repeatedly.
    lua_Integer pivot(lua_Integer first, lua_Integer last) {
        const lua_Integer size = last - first;
        if (!scatter_ || size <= large_range) return first + size / 2;
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX
        const auto quarter = std::uint64_t(size / 4);
        return first + lua_Integer(quarter + (state_ >> 33) % (2 * quarter));
    }

    // Items first, middle and last must be in order. Returns the pivot's final place: nothing left of it comes after
    // it, and nothing right of it before it.
    lua_Integer partition(lua_Integer first, lua_Integer last, lua_Integer middle) {
        exchange(middle, last - 1);
        lua_rawgeti(lua_, 1, last - 1);
        const int value = lua_gettop(lua_);
        lua_Integer left = first, right = last - 1;
        for (;;) {
            while (lua_rawgeti(lua_, 1, ++left), before(-1, value)) {
                if (left == last - 1) refuse_order();
                lua_pop(lua_, 1);
            }
            while (lua_rawgeti(lua_, 1, --right), before(value, -1)) {
                if (right < left) refuse_order();
                lua_pop(lua_, 1);
            }
            if (right < left) break;
            lua_rawseti(lua_, 1, left);
            lua_rawseti(lua_, 1, right);
        }
        lua_settop(lua_, value - 1);
        exchange(last - 1, left);
        return left;
    }

    void refuse_order() { luaL_error(lua_, "invalid order function for sorting"); }

    lua_State* lua_;
    bool scatter_ = false;
    std::uint64_t state_ = 0;
};

}  // namespace

int sort_table(lua_State* lua) {
    check_plain_table(lua, 1);
    const lua_Integer size = border(lua, 1);
    if (!lua_isnoneornil(lua, 2)) luaL_checktype(lua, 2, LUA_TFUNCTION);
    lua_settop(lua, 2);
    Sandbox::spend(lua, std::int64_t(4 * double(size) * std::log2(double(size) + 2)));
    Sorting(lua).sort(1, size);
    return 0;
}

}  // namespace deburr
