#include "raytracer/scene/lua_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <lua.hpp>

#include "raytracer/scene/memory_meter.hpp"
#include "raytracer/scene/scene_functions.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {
namespace {

// Deeper than any table that a scene needs: grouped solids with vectors inside.
constexpr int max_depth = 12;
static_assert(read_value_slots > 3 * max_depth);

// Names may be as long as memory allows; messages quote this many bytes of them.
constexpr std::size_t longest_quoted_name = 40;

std::string quotable(const std::string& name) { return shortened(name, longest_quoted_name); }

struct Reader {
    lua_State* lua;
    MemoryMeter* memory;
    ReadCost& cost;

    void take(std::size_t bytes) {
        if (memory) memory->take(bytes);
        cost.bytes += bytes;
    }
    std::string take_text(const char* text, std::size_t size) {
        take(block_bytes(size + 1));
        return std::string(text, size);
    }

    LuaValue read(int index, const std::string& location, int depth);
    LuaValue read_table(int index, const std::string& location, int depth);
};

LuaValue Reader::read(int index, const std::string& location, int depth) {
    ++cost.values;
    take(sizeof(LuaValue));
    switch (lua_type(lua, index)) {
        case LUA_TNONE:
        case LUA_TNIL: return {};
        case LUA_TBOOLEAN: return lua_toboolean(lua, index) != 0;
        case LUA_TNUMBER: return lua_tonumber(lua, index);
        case LUA_TSTRING: {
            std::size_t size = 0;
            const char* text = lua_tolstring(lua, index, &size);
            return take_text(text, size);
        }
        case LUA_TLIGHTUSERDATA: return static_cast<const SceneObject*>(lua_touserdata(lua, index));
        case LUA_TTABLE: return read_table(lua_absindex(lua, index), location, depth);
        default: return LuaOther{lua_typename(lua, lua_type(lua, index))};
    }
}

LuaValue Reader::read_table(int index, const std::string& location, int depth) {
    if (depth == max_depth)
        throw BadValue(location, fmt::format("expected tables nested at most {} deep, got deeper", max_depth));
    // Lua's order of keys differs from run to run, and so would the error that is found first; therefore keys are
    // sorted. Those that are names wait on the stack, since pushing a string anew might not return.
    std::vector<lua_Integer> numbers;
    std::vector<std::pair<std::string, int>> names;  // with their stack index
    std::string other;                               // the least key of another type
    const int top = lua_gettop(lua);
    take(block_bytes(sizeof(LuaTable) + 2 * sizeof(void*)));
    const auto room = [&] {
        if (!lua_checkstack(lua, 8)) throw BadValue(location, "expected fewer fields, got too many");
    };
    for (lua_pushnil(lua); room(), lua_next(lua, index);) {
        lua_pop(lua, 1);
        if (lua_type(lua, -1) == LUA_TSTRING) {
            std::size_t size = 0;
            const char* text = lua_tolstring(lua, -1, &size);
            take(3 * sizeof(names[0]) + block_bytes(sizeof(LuaTable::Field) + 4 * sizeof(void*)) +
                 block_bytes(size + 1));
            names.emplace_back(take_text(text, size), lua_gettop(lua));
            lua_pushvalue(lua, -1);  // one copy stays, the other is for lua_next
        } else if (lua_isinteger(lua, -1)) {
            take(3 * sizeof(lua_Integer));
            numbers.push_back(lua_tointeger(lua, -1));
        } else {
            const std::string key = described(read(-1, location, depth + 1));
            if (other.empty() || key < other) other = key;
        }
    }
    if (!other.empty()) throw BadValue(location, "expected names or 1, 2, … as keys, got " + other);
    std::sort(names.begin(), names.end());
    std::sort(numbers.begin(), numbers.end());

    auto table = std::make_shared<LuaTable>();
    table->list.reserve(numbers.size());
    for (const auto& [name, at] : names) {
        lua_pushvalue(lua, at);
        lua_rawget(lua, index);
        LuaValue value = read(-1, location + "." + quotable(name), depth + 1);
        lua_pop(lua, 1);
        table->fields.emplace(name, std::move(value));
    }
    for (const lua_Integer key : numbers) {
        const auto next = lua_Integer(table->list.size()) + 1;
        if (key != next)
            throw BadValue(location, fmt::format("expected a list without holes, got item {} but no item {}",
                                                 numbers.back(), next));
        lua_rawgeti(lua, index, key);
        table->list.push_back(read(-1, location, depth + 1));
        lua_pop(lua, 1);
    }
    lua_settop(lua, top);
    return std::shared_ptr<const LuaTable>(std::move(table));
}

const LuaValue nil_value;

}  // namespace

LuaValue read_value(lua_State* lua, int index, const std::string& location, MemoryMeter* memory, ReadCost* cost) {
    ReadCost ignored;
    return Reader{lua, memory, cost ? *cost : ignored}.read(index, location, 0);
}

std::string described(const LuaValue& value) {
    struct Describe {
        std::string operator()(std::monostate) const { return "nothing"; }
        std::string operator()(bool b) const { return b ? "true" : "false"; }
        std::string operator()(double x) const { return std::isnan(x) ? "nan" : fmt::format("{}", x); }
        std::string operator()(const std::string& s) const { return fmt::format("'{}'", quotable(s)); }
        std::string operator()(const SceneObject* object) const { return kind_of(*object); }
        std::string operator()(const std::shared_ptr<const LuaTable>& table) const {
            if (!table->fields.empty()) return "a table with names";
            if (table->list.empty()) return "an empty table";
            constexpr std::size_t longest = 4;
            std::string list;
            for (std::size_t i = 0; i < table->list.size(); ++i) {
                if (i == longest || as_table(table->list[i])) return fmt::format("a list of {}", table->list.size());
                list += (i ? ", " : "{") + described(table->list[i]);
            }
            return list + "}";
        }
        std::string operator()(LuaOther other) const { return std::string("a ") + other.type; }
    };
    return std::visit(Describe{}, value);
}

void expected(const std::string& location, const std::string& what, const LuaValue& got) {
    throw BadValue(location, "expected " + what + ", got " + described(got));
}

bool is_nil(const LuaValue& value) { return std::holds_alternative<std::monostate>(value); }

const SceneObject* as_object(const LuaValue& value) {
    const auto* object = std::get_if<const SceneObject*>(&value);
    return object ? *object : nullptr;
}

const LuaTable* as_table(const LuaValue& value) {
    const auto* table = std::get_if<std::shared_ptr<const LuaTable>>(&value);
    return table ? table->get() : nullptr;
}

static bool finite_number(const LuaValue& value) {
    const double* x = std::get_if<double>(&value);
    return x && std::isfinite(*x);
}

double number(const LuaValue& value, const std::string& location) {
    if (!finite_number(value)) expected(location, "a finite number", value);
    return std::get<double>(value);
}

double number_at_least(const LuaValue& value, const std::string& location, double least) {
    if (!finite_number(value) || std::get<double>(value) < least)
        expected(location, fmt::format("a number >= {}", least), value);
    return std::get<double>(value);
}

double number_above(const LuaValue& value, const std::string& location, double limit) {
    if (!finite_number(value) || std::get<double>(value) <= limit)
        expected(location, fmt::format("a number > {}", limit), value);
    return std::get<double>(value);
}

double number_between(const LuaValue& value, const std::string& location, double least, double most) {
    if (!finite_number(value) || std::get<double>(value) < least || std::get<double>(value) > most)
        expected(location, fmt::format("a number from {} to {}", least, most), value);
    return std::get<double>(value);
}

bool boolean(const LuaValue& value, const std::string& location) {
    const bool* flag = std::get_if<bool>(&value);
    if (!flag) expected(location, "true or false", value);
    return *flag;
}

int integer(const LuaValue& value, const std::string& location, int least, int most) {
    const double* x = std::get_if<double>(&value);
    if (!x || !(*x >= least && *x <= most) || *x != std::floor(*x))
        expected(location, fmt::format("a whole number from {} to {}", least, most), value);
    return int(*x);
}

const std::string& text(const LuaValue& value, const std::string& location) {
    const auto* string = std::get_if<std::string>(&value);
    if (!string) expected(location, "a text", value);
    return *string;
}

static bool three_numbers(const LuaValue& value) {
    const LuaTable* table = as_table(value);
    return table && table->fields.empty() && table->list.size() == 3 &&
           std::all_of(table->list.begin(), table->list.end(), finite_number);
}

Vec3 vector(const LuaValue& value, const std::string& location) {
    if (!three_numbers(value)) expected(location, "three finite numbers {x, y, z}", value);
    Vec3 v(0.0);
    for (int k = 0; k < 3; ++k) v[k] = std::get<double>(as_table(value)->list[k]);
    return v;
}

Vec3 direction(const LuaValue& value, const std::string& location) {
    const Vec3 v = vector(value, location);
    const double largest = glm::max(std::abs(v.x), glm::max(std::abs(v.y), std::abs(v.z)));
    if (largest == 0) expected(location, "a direction other than {0, 0, 0}", value);
    const Vec3 scaled = v / largest;  // so that squares stay in range
    return scaled / glm::length(scaled);
}

double view_angle(const LuaValue& value, const std::string& location) {
    const double* angle = std::get_if<double>(&value);
    if (!angle || !(*angle > 0 && *angle < 180)) expected(location, "a number of degrees between 0 and 180", value);
    return *angle;
}

Vec3 color(const LuaValue& value, const std::string& location, double most) {
    const auto in_range = [&](double x) { return x >= 0 && x <= most; };
    if (finite_number(value) && in_range(std::get<double>(value))) return Vec3(std::get<double>(value));
    if (three_numbers(value)) {
        const Vec3 c = vector(value, location);
        if (in_range(c.x) && in_range(c.y) && in_range(c.z)) return c;
    }
    expected(location,
             most < infinity ? fmt::format("a colour, {{r, g, b}} or a number, from 0 to {}", most)
                             : std::string("a colour, {r, g, b} or a number, >= 0"),
             value);
}

Fields::Fields(const LuaValue& value, std::string location, std::initializer_list<const char*> known)
    : location_(std::move(location)) {
    if (const auto* table = std::get_if<std::shared_ptr<const LuaTable>>(&value)) table_ = *table;
    if (!table_ || !table_->list.empty())
        expected(location_.empty() ? "scene" : location_, "a table of named fields", value);
    for (const auto& [name, field] : table_->fields) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        throw BadValue(this->location(name),
                       fmt::format("expected one of the fields {}, got '{}'", fmt::join(known, ", "), quotable(name)));
    }
}

const LuaValue* Fields::find(const std::string& name) const {
    const auto found = table_->fields.find(name);
    return found == table_->fields.end() ? nullptr : &found->second;
}

const LuaValue& Fields::get(const std::string& name) const {
    const LuaValue* value = find(name);
    return value ? *value : nil_value;
}

std::string Fields::location(const std::string& name) const {
    return location_.empty() ? quotable(name) : location_ + "." + quotable(name);
}

}  // namespace deburr
