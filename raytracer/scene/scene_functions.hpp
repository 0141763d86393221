// The functions that a scene calls: what they take, check and make.
//
// Objects live in SceneBuilder until the scene has been read; Lua holds bare pointers to them
// (light userdata, which scenes cannot forge), so nothing is left to a collector.
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

/// A closed mesh from a file, where the scene has moved it.
struct PlacedModel {
    ClosedMeshPtr mesh;
    Affine map;
    std::string file;  // as the scene names it
};

/// What a scene's function made. A scene has a million of them where it places a block that often, so what is large and
/// rare is kept elsewhere.
struct SceneObject {
    template <class T>
    static constexpr bool is_handle = std::is_same_v<T, Density> || std::is_same_v<T, Solid>;
    template <class T>
    using Kept = std::conditional_t<is_handle<T>, T, std::shared_ptr<const T>>;

    std::variant<Kept<Density>, Kept<Solid>, Kept<Quadric>, Kept<Perturbation>, Kept<Material>, Kept<Light>,
                 Kept<Texture>, Kept<Background>, Kept<PlacedModel>, Kept<Framing>>
        is;
    SceneName name;  // of a solid; null: none
    int line = 0;    // of the scene, where it was made
};

/// The T that `object` is, or null.
template <class T>
const T* as(const SceneObject* object) {
    const auto* kept = object ? std::get_if<SceneObject::Kept<T>>(&object->is) : nullptr;
    if constexpr (SceneObject::is_handle<T>)
        return kept;
    else
        return kept ? kept->get() : nullptr;
}

/// The kind of object in the words of a message, as "a density".
std::string kind_of(const SceneObject& object);

/// Thrown where work that is about to be done is more than is left of the budget.
struct WorkSpent : std::exception {};

/// Result that a function gives back to the scene.
struct Argument {  // the argument with this number, counted from 1
    int index;
};
using SceneResult = std::variant<Argument, const SceneObject*, bool, double, long long, std::string>;

class SceneBuilder {
public:
    /// `max_part_bytes`: see SandboxLimits::parts.
    SceneBuilder(const std::map<std::string, std::string>& defines, SceneFiles files, std::size_t max_part_bytes)
        : defines_(defines), files_(std::move(files)), max_part_bytes_(max_part_bytes) {}

    template <class T>
    const SceneObject* make(T object, int line, SceneName name = nullptr) {
        if constexpr (SceneObject::is_handle<T>) {
            return keep({std::move(object), std::move(name), line});
        } else {
            keep_parts(block_bytes(sizeof(T) + 2 * sizeof(void*)));
            return keep({std::make_shared<const T>(std::move(object)), std::move(name), line});
        }
    }
    /// The solid that `object` is or, for a density or a quadric, means.
    Solid solid(const SceneObject& object);
    /// The model of a file, which is read once. Throws std::runtime_error, SceneError and UnsupportedError.
    const ClosedMeshPtr& model(const std::string& file);
    /// The model rounded by a ball of this radius, but for what is kept; 0: as it stands.
    Solid solid(const PlacedModel& model, double radius, int line, const KeepSharp& keep = {});
    /// Files that were read, and what was mended in them: "part.stl: turned 12 facets that faced inward".
    const std::vector<std::string>& notes() const { return notes_; }
    const std::vector<std::string>& files() const { return files_read_; }
    /// The path of the scene's file of this name. Throws as SceneFiles does.
    std::string path_of(const std::string& file);
    /// A file of Lua that include() has named.
    struct Part {
        std::string text;
        int lines_before = 0;  // in the numbering of all files
        std::string name;
    };
    /// The part at this path in the scene's folders, which is read once. Throws std::runtime_error and SceneError.
    const Part& part(const std::string& name);
    /// The place of a material in materials(); each has one, however often it is used.
    int index_of(const SceneObject* material);
    /// param(): the value that the command line gives in place of `fallback`, if any.
    SceneResult parameter(const std::string& name, const LuaValue& fallback);

    const std::vector<Material>& materials() const { return materials_; }
    const std::map<std::string, std::string>& parameters() const { return parameters_; }

    /// Throws if there are more than max_half_spaces.
    static void check_size(double half_spaces);
    /// Counts parts; throws if all take more than they may.
    void keep_parts(std::size_t bytes);
    void keep_half_spaces(std::size_t count);
    /// Charges work that is about to be done; throws WorkSpent if there is less left.
    void spend(std::int64_t amount);
    /// Takes memory until the present call from Lua ends; throws MemorySpent if there is less left.
    void borrow(std::size_t bytes);

    MemoryMeter* memory = nullptr;  // of the sandbox
    SourceMap* sources = nullptr;   // of the sandbox, while Lua runs
    bool is_unsupported = false;    // the scene failed for a file that is right but not supported
    bool z_up = false;              // the scene's axis, which some defaults follow
    bool up_mattered = false;       // one of them was used

    const Part* latest_part = nullptr;

    // What the latest call from Lua left, kept here so that it outlives every C++ frame.
    SceneResult result;
    char message[2048] = "";
    ReadCost cost;               // of its arguments, and what was borrowed
    std::int64_t work = 0;       // besides, for the sandbox's budget
    std::int64_t work_left = 0;  // before it

private:
    const SceneObject* keep(SceneObject object);

    const std::map<std::string, std::string>& defines_;
    const SceneFiles files_;
    std::map<std::string, ClosedMeshPtr> models_;  // by name
    std::map<std::string, Part> parts_;            // by path, without links
    std::size_t part_text_bytes_ = 0;
    std::vector<std::string> notes_, files_read_;
    std::map<std::string, std::string> parameters_;
    std::deque<SceneObject> objects_;
    std::vector<Material> materials_{Material{}};
    std::map<const SceneObject*, int> indices_;
    const std::size_t max_part_bytes_;
    std::size_t part_bytes_ = 0;
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
    std::string location(const char* argument) const { return std::string(name) + ": " + argument; }
    template <class T>
    const SceneObject* make(T object, SceneName object_name = nullptr) const {
        return builder.make(std::move(object), line, std::move(object_name));
    }
};

struct SceneFunction {
    enum class Kind { global, method, metamethod };
    Kind kind;
    const char* name;    // in messages, and in the scene unless it is a metamethod
    const char* symbol;  // metamethod: Lua's name for it
    SceneResult (*body)(SceneCall&);
};

/// The tables of functions, each in a file of its name (scene_shapes.cpp, …); parameter_functions: param() alone.
const std::vector<SceneFunction>& shape_functions();
const std::vector<SceneFunction>& round_functions();
const std::vector<SceneFunction>& free_form_functions();
const std::vector<SceneFunction>& model_functions();
const std::vector<SceneFunction>& operator_functions();
const std::vector<SceneFunction>& method_functions();
const std::vector<SceneFunction>& rounding_functions();
const std::vector<SceneFunction>& material_functions();
const std::vector<SceneFunction>& parameter_functions();

/// All functions of these tables.
std::vector<const SceneFunction*> scene_functions();

/// What convolved(r, model, { … }) keeps sharp.
KeepSharp keep_sharp(const LuaValue& value, const std::string& location);

/// cylinder{ from =, to =, radius = } and cone{ from =, to =, radius = }, which other fields make quadrics.
SceneResult round_cylinder(SceneCall& call);
SceneResult round_cone(SceneCall& call);

/// The quadric itself; throws if its coefficients are too large to be cubed.
const Quadric& ordinary(const Quadric& quadric, const char* function);

/// Q + Σ fᵢRᵢ as a solid. Throws where Q's sign is everywhere the same, and no perturbation could change it.
Solid solid_of_free_form(const std::string& function, const Quadric& base, std::vector<Perturbation> perturbations,
                         int line);

/// include(name), as a C function of Lua; see open_scene_functions.
int include_part(lua_State* lua);

/// Calls the function's body with the arguments on the stack and pushes its result; raises what went wrong as an error.
int call_scene_function(lua_State* lua, const SceneFunction& function);

/// Registers all functions; the sandbox's host must be a SceneBuilder. May raise Lua errors.
void open_scene_functions(lua_State* lua);

}  // namespace deburr
