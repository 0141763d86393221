#include "raytracer/scene/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "bounds/canonical_solids.hpp"
#include "raytracer/scene/default_light.hpp"
#include "raytracer/scene/frame_camera.hpp"
#include "raytracer/scene/scene_functions.hpp"
#include "raytracer/scene/scene_text.hpp"
#include "raytracer/scene/source_lines.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {
namespace {

constexpr int largest_side = 65'536;
constexpr int max_bounces = 1'000;

// Sine of the angle between up and view below which they do not determine the picture's side (chosen).
constexpr double min_sine = 1e-6;

bool read_up(const LuaValue& value) {
    const auto* name = std::get_if<std::string>(&value);
    if (!name || (*name != "y" && *name != "z")) expected("up", "'y' or 'z'", value);
    return *name == "z";
}

void read_image(const LuaValue& value, Scene& scene) {
    const Fields fields(value, "image", {"width", "height", "spp", "bounces", "caustics", "exposure"});
    const auto read = [&](const char* name, int& number, int least, int most) {
        if (const auto* given = fields.find(name)) number = integer(*given, fields.location(name), least, most);
    };
    read("width", scene.width, 1, largest_side);
    read("height", scene.height, 1, largest_side);
    if (const auto* given = fields.find("spp")) scene.spp = integer(*given, fields.location("spp"), 1, max_samples);
    read("bounces", scene.bounces, 0, max_bounces);
    if (const auto* given = fields.find("caustics")) scene.caustics = boolean(*given, fields.location("caustics"));
    if (const auto* given = fields.find("exposure"))
        scene.exposure = number_between(*given, fields.location("exposure"), -max_exposure, max_exposure);
}

// Reads {x, y}, each within a few widths or heights of the picture.
Vec3 picture_shift(const LuaValue& value, const std::string& location) {
    constexpr double most = 10;
    const LuaTable* table = as_table(value);
    if (!table || !table->fields.empty() || table->list.size() != 2) expected(location, "two numbers {x, y}", value);
    return {number_between(table->list[0], location, -most, most),
            number_between(table->list[1], location, -most, most), 0};
}

void read_camera(const LuaValue& value, Camera& camera) {
    const Fields fields(value, "camera", {"eye", "target", "up", "fov", "projection", "lens", "shift"});
    const auto read = [&](const char* name, Vec3& v) {
        if (const auto* given = fields.find(name)) v = vector(*given, fields.location(name));
    };
    read("eye", camera.eye);
    read("target", camera.target);
    if (const auto* given = fields.find("up")) camera.up = direction(*given, fields.location("up"));
    if (const auto* given = fields.find("fov")) camera.fov = view_angle(*given, fields.location("fov"));
    if (const auto* given = fields.find("projection")) {
        const auto* name = std::get_if<std::string>(given);
        if (!name || (*name != "perspective" && *name != "orthographic"))
            expected(fields.location("projection"), "'perspective' or 'orthographic'", *given);
        camera.orthographic = *name == "orthographic";
    }
    if (const auto* given = fields.find("shift")) camera.shift = picture_shift(*given, fields.location("shift"));
    if (const auto* given = fields.find("lens")) {
        const Fields lens(*given, fields.location("lens"), {"radius", "focus"});
        camera.lens_radius = number_at_least(lens.get("radius"), lens.location("radius"), 0);
        if (const auto* focus = lens.find("focus")) camera.focus = number_above(*focus, lens.location("focus"), 0);
    }
    const Vec3 view = camera.target - camera.eye;
    const double distance = glm::length(view);
    if (!(distance > 0 && std::isfinite(distance)))
        expected(fields.location("target"), "a point other than the eye", fields.get("target"));
    if (!(glm::length(glm::cross(view / distance, camera.up)) > min_sine))
        expected(fields.location("up"), "a direction not parallel to the view", fields.get("up"));
}

void read_view(const LuaValue& value, Scene& scene) {
    const SceneObject* object = as_object(value);
    if (const auto* framing = as<Framing>(object))
        scene.framing = *framing;
    else if (!as_table(value))
        expected("camera", "a table of named fields or frame{…}", value);
    else
        read_camera(value, scene.camera);
}

void read_background(const LuaValue& value, const char* name, Background& background) {
    const SceneObject* object = as_object(value);
    if (const auto* sky = as<Background>(object))
        background = *sky;
    else if (object)
        expected(name, "a colour, sky{…} or environment{…}", value);
    else
        background.color = color(value, name, infinity);
}

void read_lights(const LuaValue& value, std::vector<Light>& lights) {
    const LuaTable* table = as_table(value);
    if (!table || !table->fields.empty()) expected("lights", "a list of lights", value);
    for (const LuaValue& item : table->list) {
        const auto* light = as<Light>(as_object(item));
        if (!light) expected(fmt::format("lights[{}]", lights.size() + 1), "a light", item);
        lights.push_back(*light);
    }
}

void read_solids(const LuaValue& value, SceneBuilder& builder, Scene& scene) {
    const LuaTable* table = as_table(value);
    if (!table || !table->fields.empty() || table->list.empty())
        expected("solids", "a list of at least one solid", value);
    for (const LuaValue& item : table->list) {
        const std::string location = fmt::format("solids[{}]", scene.solids.size() + 1);
        const SceneObject* object = as_object(item);
        if (!as<Solid>(object) && !as<Density>(object) && !as<Quadric>(object) && !as<PlacedModel>(object))
            expected(location, "a solid or a density", item);
        scene.solids.push_back(builder.solid(*object));
        const std::string name = object->name ? *object->name : "";
        builder.memory->take_text(name.size());
        scene.names.push_back(name);
    }
    const double half_spaces = half_spaces_to_lay_out(scene.solids);
    if (half_spaces > max_half_spaces)
        throw BadValue("solids", fmt::format("expected at most {} half-spaces, got {}", count_text(max_half_spaces),
                                             count_text(half_spaces)));
}

void read_table(const LuaValue& value, SceneBuilder& builder, Scene& scene) {
    if (!as_table(value)) expected("scene", "the chunk to return a table, return { solids = { … } }", value);
    const Fields fields(value, "",
                        {"up", "image", "camera", "lights", "background", "environment", "ambient", "solids"});
    if (const auto* given = fields.find("up")) scene.z_up = read_up(*given);
    scene.camera.up = up_axis(scene.z_up);
    if (scene.z_up) scene.camera.eye = default_framing(true).from;
    if (const auto* given = fields.find("image")) read_image(*given, scene);
    if (const auto* given = fields.find("camera"))
        read_view(*given, scene);
    else
        scene.framing = default_framing(scene.z_up);
    if (const auto* given = fields.find("background")) read_background(*given, "background", scene.background);
    if (const auto* given = fields.find("environment"))
        read_background(*given, "environment", scene.environment.emplace());
    scene.background.z_up = scene.z_up;
    if (scene.environment) scene.environment->z_up = scene.z_up;
    if (const auto* given = fields.find("ambient")) scene.ambient = color(*given, "ambient", infinity);
    if (const auto* given = fields.find("lights"))
        read_lights(*given, scene.lights);
    else if (!fields.find("ambient"))
        add_default_light(scene, fields.find("background") || fields.find("environment"));
    if (scene.default_light) aim_default_light(scene);
    read_solids(fields.get("solids"), builder, scene);
}

void check_defines(const std::map<std::string, std::string>& defines,
                   const std::map<std::string, std::string>& parameters) {
    for (const auto& [name, value] : defines) {
        if (parameters.count(name)) continue;
        std::string known;
        for (const auto& parameter : parameters) {
            constexpr std::size_t longest = 400;
            known += (known.empty() ? "" : ", ") + shortened(parameter.first, longest);
            if (known.size() > longest) break;
        }
        throw std::runtime_error(
            fmt::format("-D {}: ", name) +
            (known.empty() ? "expected no parameters, the scene has none"
                           : fmt::format("expected one of the scene's parameters {}, got '{}'", known, name)));
    }
}

// Makes images on surfaces upright in a scene where z is up.
void turn_up(Material& m) {
    const auto turned = [](Texture texture) {
        texture.z_up = true;
        return texture;
    };
    m.color = turned(m.color);
    for (auto* texture : {&m.roughness_texture, &m.metallic_texture, &m.bump})
        if (*texture) *texture = std::make_shared<const Texture>(turned(**texture));
}

struct SceneSource {
    const std::string& text;
    const std::string& file;
    const std::map<std::string, std::string>& defines;
    const std::vector<std::string>& model_folders;
};

// Whether the text contains up = "z" anywhere.
bool seems_z_up(const std::string& text) {
    for (std::size_t at = 0; (at = text.find("up", at)) != std::string::npos;) {
        const auto is_next = [&](const char* any) {
            at = text.find_first_not_of(" \t\n", at);
            return at != std::string::npos && std::strchr(any, text[at]) && text[at];
        };
        at += 2;
        if (!is_next("=")) continue;
        ++at;
        if (is_next("\"'") && text.compare(at + 1, 1, "z") == 0) return true;
        if (at == std::string::npos) break;
    }
    return false;
}

// Runs the scene with y or z up; `up_mattered` is set to whether the result depends on that.
Scene run_scene(const SceneSource& source, const SandboxLimits& limits, bool z_up, bool& up_mattered) {
    const auto& [text, file, defines, model_folders] = source;
    SceneBuilder builder(defines, SceneFiles(file, model_folders), limits.parts);
    builder.z_up = z_up;
    Sandbox sandbox(limits, &builder);
    lua_State* lua = nullptr;
    try {
        lua = sandbox.run(text, file, open_scene_functions);
    } catch (const SceneError& error) {
        if (builder.is_unsupported) throw UnsupportedError(error.what());
        throw;
    }
    builder.memory = &sandbox.memory();
    Scene scene;
    scene.file = file;
    try {
        read_table(read_value(lua, 1, "scene", builder.memory), builder, scene);
        check_defines(defines, builder.parameters());
    } catch (const BadValue& error) {
        const int line = line_of(text, error.location);
        throw SceneError(one_line(line > 0 ? fmt::format("{}:{}: {}", file_mark, line, error.what())
                                           : fmt::format("{}: {}", file_mark, error.what()),
                                  file));
    } catch (const MemorySpent&) {
        throw SceneError(
            one_line(fmt::format("{}:{}: {}", file_mark, line_of(text, "scene"), sandbox.memory_reason()), file));
    } catch (const SceneError&) {
        throw;
    } catch (const std::runtime_error& error) {
        throw SceneError(one_line(error.what(), file));
    }
    scene.parameters = builder.parameters();
    scene.materials = builder.materials();
    if (scene.z_up)
        for (Material& m : scene.materials) turn_up(m);
    scene.sources = sandbox.sources();
    scene.notes = builder.notes();
    scene.model_files = builder.files();
    up_mattered = builder.up_mattered;
    return scene;
}

}  // namespace

Scene read_scene_text(const std::string& given, const std::string& file,
                      const std::map<std::string, std::string>& defines, const SandboxLimits& limits,
                      const std::vector<std::string>& model_folders) {
    const std::string text = scene_text(given, file);
    const SceneSource source{text, file, defines, model_folders};
    // A scene returns its up axis only after its prisms are made, so it is run with the axis that its text suggests. As
    // it has neither clock nor memory, a second run with the other axis does the same.
    const bool guess = seems_z_up(text);
    bool up_mattered = false;
    Scene scene;
    try {
        scene = run_scene(source, limits, guess, up_mattered);
    } catch (const SceneError& error) {
        const std::string message = error.what();
        const std::string hint = other_language_in_lua(text);
        if (hint.empty() || message.find("; this looks like ") != std::string::npos) throw;
        throw SceneError(message + hint);
    }
    if (scene.z_up == guess || !up_mattered) return scene;
    SandboxLimits again = limits;
    again.mute = true;
    scene = run_scene(source, again, !guess, up_mattered);
    if (scene.z_up == guess) throw SceneError(one_line("up: expected one that does not depend on itself", file));
    return scene;
}

Scene read_scene(const std::string& file, const std::map<std::string, std::string>& defines,
                 const SandboxLimits& limits, const std::vector<std::string>& model_folders) {
    return read_scene_text(text_of_file(file), file, defines, limits, model_folders);
}

}  // namespace deburr
