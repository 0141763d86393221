// Lua values as C++ values, and the checks that turn them into numbers, vectors and fields.
//
// A value is copied whole before anything looks at it, with functions of Lua that neither raise nor
// allocate; so the code that checks and builds is C++ alone and may throw.
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
struct SceneObject;  // what a scene's functions make: scene_functions.hpp
struct LuaTable;
struct LuaOther {  // function, coroutine
    const char* type;
};

using LuaValue = std::variant<std::monostate, bool, double, std::string, const SceneObject*,
                              std::shared_ptr<const LuaTable>, LuaOther>;

struct LuaTable {
    using Field = std::pair<const std::string, LuaValue>;
    std::vector<LuaValue> list;  // 1, 2, …
    std::map<std::string, LuaValue> fields;
};

/// A value that is not what is expected; what() is "place: expected …, got …".
class BadValue : public std::runtime_error {
public:
    BadValue(std::string of_value, const std::string& message)
        : std::runtime_error(of_value + ": " + message), location(std::move(of_value)) {}

    std::string location;  // names joined by dots, as in "camera.fov"
};

/// Free stack slots that read_value needs.
constexpr int read_value_slots = 40;

/// A copy of the value at `index`. Throws BadValue at tables with holes, other keys than names and 1, 2, …,
/// and at those nested so deep that they may contain themselves.
///
/// `memory`, if given, lends what the copy takes: MemorySpent is thrown where there is less. `cost`, if given, grows by
/// what was read and taken, also when it throws.
struct ReadCost {
    std::int64_t values = 0;
    std::size_t bytes = 0;
};
LuaValue read_value(lua_State* lua, int index, const std::string& location, MemoryMeter* memory = nullptr,
                    ReadCost* cost = nullptr);

/// The value in the words of a message, as "a density".
std::string described(const LuaValue& value);
[[noreturn]] void expected(const std::string& location, const std::string& what, const LuaValue& got);

bool is_nil(const LuaValue& value);
/// The object in `value`, or null.
const SceneObject* as_object(const LuaValue& value);
/// The table in `value`, or null.
const LuaTable* as_table(const LuaValue& value);

/// All of these are finite.
double number(const LuaValue& value, const std::string& location);
double number_at_least(const LuaValue& value, const std::string& location, double least);
double number_above(const LuaValue& value, const std::string& location, double limit);
double number_between(const LuaValue& value, const std::string& location, double least, double most);
int integer(const LuaValue& value, const std::string& location, int least, int most);
bool boolean(const LuaValue& value, const std::string& location);
const std::string& text(const LuaValue& value, const std::string& location);
Vec3 vector(const LuaValue& value, const std::string& location);
/// The direction as a vector of length 1, exact for a multiple of an axis; {0, 0, 0} is refused.
Vec3 direction(const LuaValue& value, const std::string& location);
/// Degrees between 0 and 180.
double view_angle(const LuaValue& value, const std::string& location);
/// {r, g, b} or one number for grey, each in [0, most].
Vec3 color(const LuaValue& value, const std::string& location, double most);

/// A table of named fields, which are all among `known`.
class Fields {
public:
    Fields(const LuaValue& value, std::string location, std::initializer_list<const char*> known);

    /// Null where the field is missing.
    const LuaValue* find(const std::string& name) const;
    /// nil where the field is missing.
    const LuaValue& get(const std::string& name) const;
    std::string location(const std::string& name) const;

private:
    std::shared_ptr<const LuaTable> table_;
    std::string location_;
};

}  // namespace deburr
