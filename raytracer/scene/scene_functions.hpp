// The functions that a scene can call: the values that they check and make, and how Lua calls them.
//
// Objects belong to SceneBuilder until the scene has been read. Lua has bare pointers to them (light userdata, which
// scenes cannot forge), so nothing depends on a garbage collector.
#pragma once
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "bounds/closed_mesh.hpp"
#include "bounds/free_form.hpp"
#include "raytracer/scene/keep_sharp.hpp"
#include "raytracer/scene/lua_values.hpp"
#include "raytracer/scene/memory_meter.hpp"
#include "raytracer/scene/scene.hpp"
#include "raytracer/scene/scene_files.hpp"

struct lua_State;

namespace deburr {

using SceneName = std::shared_ptr<const std::string>;

/// A closed mesh from a file, with the transform that the scene gave it.
struct PlacedModel {
    ClosedMeshPtr mesh;
    Affine map;
    std::string file;  // name in the scene
};

/// A value made by a scene's function. A scene that places a block a million times has as many of these, so what is
/// large and rare is stored elsewhere.
struct SceneObject {
    template <class T>
    static constexpr bool is_handle = std::is_same_v<T, Density> || std::is_same_v<T, Solid>;
    template <class T>
    using Kept = std::conditional_t<is_handle<T>, T, std::shared_ptr<const T>>;

    std::variant<Kept<Density>, Kept<Solid>, Kept<Quadric>, Kept<Perturbation>, Kept<Material>, Kept<Light>,
                 Kept<Texture>, Kept<Background>, Kept<PlacedModel>, Kept<Framing>>
        is;
    SceneName name;  // of a solid; null: none
    int line = 0;    // line of the scene that made it
};

/// The T in `object`; null if it is none.
template <class T>
const T* as(const SceneObject* object) {
    const auto* kept = object ? std::get_if<SceneObject::Kept<T>>(&object->is) : nullptr;
    if constexpr (SceneObject::is_handle<T>)
        return kept;
    else
        return kept ? kept->get() : nullptr;
}

/// The kind of object for a message, such as "a density".
std::string kind_of(const SceneObject& object);

/// Thrown before work for which too little is left of the budget.
struct WorkSpent : std::exception {};

/// Refers to one of the call's arguments.
struct Argument {  // counted from 1
    int index;
};
using SceneResult = std::variant<Argument, const SceneObject*, bool, double, long long, std::string>;

/// Makes and owns the objects of a scene while it is read.
class SceneBuilder {
public:
    /// `defines` are the parameters of the command line. `max_part_bytes`: see SandboxLimits::parts.
    SceneBuilder(const std::map<std::string, std::string>& defines, SceneFiles files, std::size_t max_part_bytes)
        : defines_(defines), files_(std::move(files)), max_part_bytes_(max_part_bytes) {}

    /// Stores an object that the given line of the scene made.
    template <class T>
    const SceneObject* make(T object, int line, SceneName name = nullptr) {
        if constexpr (SceneObject::is_handle<T>) {
            return keep({std::move(object), std::move(name), line});
        } else {
            keep_parts(block_bytes(sizeof(T) + 2 * sizeof(void*)));
            return keep({std::make_shared<const T>(std::move(object)), std::move(name), line});
        }
    }
    /// The solid in `object`, or the one that a density or quadric stands for.
    Solid solid(const SceneObject& object);
    /// The mesh in a file, which is read once. Throws std::runtime_error, SceneError and UnsupportedError.
    const ClosedMeshPtr& model(const std::string& file);
    /// The model as a solid, rounded by a ball of this radius except for what is kept sharp; radius 0: not rounded.
    Solid solid(const PlacedModel& model, double radius, int line, const KeepSharp& keep = {});
    /// Repairs of models, such as "part.stl: turned 12 facets that faced inward", and the files that were read.
    const std::vector<std::string>& notes() const { return notes_; }
    const std::vector<std::string>& files() const { return files_read_; }
    /// The path of the scene's file of this name. Throws as SceneFiles::path_of() does.
    std::string path_of(const std::string& file);
    /// A Lua file that include() has named.
    struct Part {
        std::string text;
        int lines_before = 0;  // in the numbering of all files
        std::string name;
    };
    /// The Lua file of this name in the scene's folders, which is read once. Throws std::runtime_error and SceneError.
    const Part& part(const std::string& name);
    /// The index of a material in materials(); each material has one, however often it is used.
    int index_of(const SceneObject* material);
    /// The result of param(): the value that the command line gives, or else `fallback`.
    SceneResult parameter(const std::string& name, const LuaValue& fallback);

    const std::vector<Material>& materials() const { return materials_; }
    const std::map<std::string, std::string>& parameters() const { return parameters_; }

    /// Throws std::runtime_error if there are more than max_half_spaces.
    static void check_size(double half_spaces);
    /// Both count memory of the scene's parts, and throw std::runtime_error if all parts together exceed their limit.
    void keep_parts(std::size_t bytes);
    void keep_half_spaces(std::size_t count);
    /// Charges work that is about to be done; throws WorkSpent if less is left.
    void spend(std::int64_t amount);
    /// Charges memory until the current call from Lua ends; throws MemorySpent if less is left.
    void borrow(std::size_t bytes);

    MemoryMeter* memory = nullptr;  // the sandbox's
    SourceMap* sources = nullptr;   // the sandbox's, while Lua runs
    bool is_unsupported = false;    // whether the scene failed because of a valid file that is not supported
    bool z_up = false;              // the up axis that some defaults follow
    bool up_mattered = false;       // whether such a default was used

    const Part* latest_part = nullptr;

    // The outcome of the latest call from Lua, stored here so that it outlives all C++ frames.
    SceneResult result;
    char message[2048] = "";
    ReadCost cost;               // of reading the arguments, and what was borrowed
    std::int64_t work = 0;       // further work for the sandbox's budget
    std::int64_t work_left = 0;  // of the budget, before the call

private:
    const SceneObject* keep(SceneObject object);

    const std::map<std::string, std::string>& defines_;
    const SceneFiles files_;
    std::map<std::string, ClosedMeshPtr> models_;  // by name
    std::map<std::string, Part> parts_;            // by path, with links resolved
    std::size_t part_text_bytes_ = 0;
    std::vector<std::string> notes_, files_read_;
    std::map<std::string, std::string> parameters_;
    std::deque<SceneObject> objects_;
    std::vector<Material> materials_{Material{}};
    std::map<const SceneObject*, int> indices_;
    const std::size_t max_part_bytes_;
    std::size_t part_bytes_ = 0;
};

/// A call of a function by a scene.
struct SceneCall {
    SceneBuilder& builder;
    const char* name;
    int line;
    std::vector<LuaValue> arguments;

    /// The argument; nil if there are fewer.
    const LuaValue& argument(std::size_t index) const;
    /// Throws BadValue if there are more arguments than this.
    void at_most(std::size_t count) const;
    /// The location of an argument for messages: "name: argument".
    std::string location(const char* argument) const { return std::string(name) + ": " + argument; }
    template <class T>
    const SceneObject* make(T object, SceneName object_name = nullptr) const {
        return builder.make(std::move(object), line, std::move(object_name));
    }
};

/// A function of the scene language.
struct SceneFunction {
    /// How the scene names it: a global function, a method of objects, or a metamethod.
    enum class Kind { global, method, metamethod };
    Kind kind;
    const char* name;    // in messages; in the scene, too, unless it is a metamethod
    const char* symbol;  // Lua's name of a metamethod
    SceneResult (*body)(SceneCall&);
};

/// The tables of functions, each in the file of its name (scene_shapes.cpp etc.); parameter_functions() has param()
/// only.
const std::vector<SceneFunction>& shape_functions();
const std::vector<SceneFunction>& round_functions();
const std::vector<SceneFunction>& free_form_functions();
const std::vector<SceneFunction>& model_functions();
const std::vector<SceneFunction>& operator_functions();
const std::vector<SceneFunction>& method_functions();
const std::vector<SceneFunction>& rounding_functions();
const std::vector<SceneFunction>& material_functions();
const std::vector<SceneFunction>& parameter_functions();

/// The functions of all tables.
std::vector<const SceneFunction*> scene_functions();

/// Reads the table of convolved(r, model, { … }) that says what stays sharp.
KeepSharp keep_sharp(const LuaValue& value, const std::string& location);

/// cylinder{ from =, to =, radius = } and cone{ from =, to =, radius = }, which are round parts; with other fields
/// these functions make quadrics.
SceneResult round_cylinder(SceneCall& call);
SceneResult round_cone(SceneCall& call);

/// Returns the quadric; throws if its coefficients are too large to be cubed. `function` names the caller in the
/// message.
const Quadric& ordinary(const Quadric& quadric, const char* function);

/// Q + Σ fᵢRᵢ as a solid. Throws if Q has the same sign everywhere and no perturbation could change it.
Solid solid_of_free_form(const std::string& function, const Quadric& base, std::vector<Perturbation> perturbations,
                         int line);

/// include(name) as a lua_CFunction; see open_scene_functions().
int include_part(lua_State* lua);

/// Calls the function's body with the arguments on Lua's stack and pushes its result; raises errors as Lua errors.
int call_scene_function(lua_State* lua, const SceneFunction& function);

/// Registers all functions in the state, whose host must be a SceneBuilder. May raise Lua errors.
void open_scene_functions(lua_State* lua);

}  // namespace deburr
