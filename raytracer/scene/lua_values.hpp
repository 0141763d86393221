// Lua values as C++ values, and the checks that turn them into numbers, vectors and fields.
//
// A value is first copied whole, by Lua functions that neither raise nor allocate, so that the code that checks it and
// builds from it is C++ only and may throw.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "bounds/vec.hpp"

struct lua_State;

namespace deburr {

class MemoryMeter;
struct SceneObject;  // a value made by a scene's functions: scene_functions.hpp
struct LuaTable;
struct LuaOther {  // a function or coroutine
    const char* type;
};

using LuaValue = std::variant<std::monostate, bool, double, std::string, const SceneObject*,
                              std::shared_ptr<const LuaTable>, LuaOther>;

/// A copy of a table with only positive integer keys without holes, names, or both.
struct LuaTable {
    using Field = std::pair<const std::string, LuaValue>;
    std::vector<LuaValue> list;  // items 1, 2, …
    std::map<std::string, LuaValue> fields;
};

/// The value is not what is expected; what() is "location: expected …, got …".
class BadValue : public std::runtime_error {
public:
    BadValue(std::string of_value, const std::string& message)
        : std::runtime_error(of_value + ": " + message), location(std::move(of_value)) {}

    std::string location;  // names joined by dots, such as "camera.fov"
};

/// The free stack slots that read_value() needs.
constexpr int read_value_slots = 40;

/// The cost of read_value(): the number of values read, and the bytes of their copy.
struct ReadCost {
    std::int64_t values = 0;
    std::size_t bytes = 0;
};
/// A copy of the value at `index`. Throws BadValue for tables with holes, for keys other than names and 1, 2, …, and
/// for tables nested so deeply that they may contain themselves.
/// `memory`, if given, is charged for the copy: MemorySpent is thrown if not enough is left. `cost`, if given, is
/// increased by what was read, even if the function throws.
LuaValue read_value(lua_State* lua, int index, const std::string& location, MemoryMeter* memory = nullptr,
                    ReadCost* cost = nullptr);

/// The kind of value for a message, such as "a density".
std::string described(const LuaValue& value);
/// Throws BadValue: "location: expected WHAT, got …".
[[noreturn]] void expected(const std::string& location, const std::string& what, const LuaValue& got);

bool is_nil(const LuaValue& value);
/// The object in `value`, or null.
const SceneObject* as_object(const LuaValue& value);
/// The table in `value`, or null.
const LuaTable* as_table(const LuaValue& value);

/// Each of the following returns the value as the type in its name, or throws BadValue. All numbers are finite.
double number(const LuaValue& value, const std::string& location);
double number_at_least(const LuaValue& value, const std::string& location, double least);
double number_above(const LuaValue& value, const std::string& location, double limit);
double number_between(const LuaValue& value, const std::string& location, double least, double most);
int integer(const LuaValue& value, const std::string& location, int least, int most);
bool boolean(const LuaValue& value, const std::string& location);
const std::string& text(const LuaValue& value, const std::string& location);
Vec3 vector(const LuaValue& value, const std::string& location);
/// A vector of length 1, exact for a multiple of an axis; {0, 0, 0} is refused.
Vec3 direction(const LuaValue& value, const std::string& location);
/// An angle in degrees, between 0 and 180 (both excluded).
double view_angle(const LuaValue& value, const std::string& location);
/// {r, g, b}, or one number for grey; each in [0, most].
Vec3 color(const LuaValue& value, const std::string& location, double most);

/// A table of named fields. The constructor throws BadValue for other values, and for names not in `known`.
class Fields {
public:
    Fields(const LuaValue& value, std::string location, std::initializer_list<const char*> known);

    /// The field's value; null if it is missing.
    const LuaValue* find(const std::string& name) const;
    /// The field's value; nil if it is missing.
    const LuaValue& get(const std::string& name) const;
    /// The field's location for messages, such as "camera.fov".
    std::string location(const std::string& name) const;

private:
    std::shared_ptr<const LuaTable> table_;
    std::string location_;
};

}  // namespace deburr
