// The functions that a scene calls: what they take, check and make.
//
// Objects live in SceneBuilder until the scene has been read; Lua holds bare pointers to them
// (light userdata, which scenes cannot forge), so nothing is left to a collector.
#pragma once
#include <deque>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "bounds/free_form.hpp"
#include "raytracer/scene/lua_values.hpp"
#include "raytracer/scene/scene.hpp"

struct lua_State;

namespace deburr {

struct SceneObject {
    std::variant<Density, Solid, Quadric, Perturbation, Material, Light, Texture, Background> is;
    std::string name;  // of a solid; "" none
    int line = 0;      // of the scene, where it was made
};

/// As in "a density".
std::string kind_of(const SceneObject& object);

/// A scene that makes more parts than this is refused: two for an object (one is its expression's node)
/// and one for each half-space of a shape. None is freed before the end, so this bounds the memory.
constexpr std::size_t most_steps = 4'000'000;

/// What a function gives back to the scene.
struct Argument {  // the argument with this number, counted from 1
    int index;
};
using SceneResult = std::variant<Argument, const SceneObject*, bool, double, long long, std::string>;

class SceneBuilder {
public:
    explicit SceneBuilder(const std::map<std::string, std::string>& defines) : defines_(defines) {}

    const SceneObject* make(decltype(SceneObject::is) object, int line, std::string name = "");
    /// The solid that `object` is or, for a density or a quadric, means.
    Solid solid(const SceneObject& object);
    /// The place of a material in materials(); each has one, however often it is used.
    int index_of(const SceneObject* material);
    /// param(): the value that the command line gives in place of `fallback`, if any.
    SceneResult parameter(const std::string& name, const LuaValue& fallback);

    const std::vector<Material>& materials() const { return materials_; }
    const std::map<std::string, std::string>& parameters() const { return parameters_; }

    /// Throws if an expression has more than most_half_spaces.
    static void check_size(double half_spaces);
    /// Charges steps, throws if there are more than most_steps.
    void spend(std::size_t steps);

    // What the latest call from Lua left, kept here so that it outlives every C++ frame.
    SceneResult result;
    char message[2048] = "";
    std::int64_t values = 0;  // read from its arguments
    std::int64_t work = 0;    // besides, for the sandbox's budget

private:
    const std::map<std::string, std::string>& defines_;
    std::map<std::string, std::string> parameters_;
    std::deque<SceneObject> objects_;
    std::vector<Material> materials_{Material{}};
    std::map<const SceneObject*, int> indices_;
    std::size_t steps_ = 0;
};

/// One call from a scene.
struct SceneCall {
    SceneBuilder& builder;
    const char* name;
    int line;
    std::vector<LuaValue> arguments;

    /// nil if there are fewer.
    const LuaValue& argument(std::size_t index) const;
    /// Throws if there are more arguments than this.
    void at_most(std::size_t count) const;
    /// "name: argument"
    std::string place(const char* argument) const { return std::string(name) + ": " + argument; }
    const SceneObject* make(decltype(SceneObject::is) object, std::string object_name = "") const {
        return builder.make(std::move(object), line, std::move(object_name));
    }
};

struct SceneFunction {
    enum class Place { global, method, metamethod };
    Place place;
    const char* name;    // in messages, and in the scene unless it is a metamethod
    const char* symbol;  // metamethod: Lua's name for it
    SceneResult (*body)(SceneCall&);
};

/// The tables of functions: shapes, operators and placements; quadrics and free forms; materials,
/// textures and lights.
const std::vector<SceneFunction>& shape_functions();
const std::vector<SceneFunction>& form_functions();
const std::vector<SceneFunction>& look_functions();

/// The quadric itself; throws if its coefficients are too large to be cubed.
const Quadric& ordinary(const Quadric& quadric, const char* function);

/// Q + Σ fᵢRᵢ as a solid. Throws where Q's sign is everywhere the same, and no perturbation could change it.
Solid solid_of_form(const std::string& function, const Quadric& base, std::vector<Perturbation> perturbations,
                    int line);

/// Registers all functions; the sandbox's host must be a SceneBuilder. May raise Lua errors.
void open_scene_functions(lua_State* lua);

}  // namespace deburr
