// Models in scenes: closed meshes from files.
#include <fmt/format.h>

#include "raytracer/model/model_file.hpp"
#include "raytracer/scene/scene_functions.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {

std::string SceneBuilder::path_of(const std::string& file) {
    std::string path = files_.path_of(file);
    files_read_.push_back(path);
    return path;
}

const ClosedMeshPtr& SceneBuilder::model(const std::string& file) {
    const auto [at, is_new] = models_.try_emplace(file);
    if (is_new) {
        const std::string path = path_of(file);
        const Model read = read_model(path);
        for (const std::string& mended : read.mended) notes_.push_back(fmt::format("{}: {}", path, mended));
        at->second = read.mesh;
    }
    return at->second;
}

Solid SceneBuilder::solid(const PlacedModel& model, double radius, int line, const KeepSharp& keep) {
    ClosedMeshPtr mesh = model.mesh;
    if (model.map.linear != Mat3(1.0) || model.map.shift != Vec3(0.0)) mesh = transformed(*mesh, model.map);
    if (keep.below || keep.above) up_mattered = true;
    return Solid::of_field(rounded_mesh(std::move(mesh), radius, keep, z_up), line);
}

namespace {

SceneResult model(SceneCall& call) {
    call.at_most(1);
    const std::string& file = text(call.argument(0), call.name);
    try {
        return call.make(PlacedModel{call.builder.model(file), {}, file});
    } catch (const BadValue&) {
        throw;
    } catch (const UnsupportedError& error) {
        call.builder.is_unsupported = true;
        throw BadValue(call.name, error.what());
    } catch (const std::runtime_error& error) {
        throw BadValue(call.name, error.what());
    }
}

}  // namespace

KeepSharp keep_sharp(const LuaValue& value, const std::string& location) {
    KeepSharp keep;
    const Fields fields(value, location, {"edges", "keep_sharp", "fade"});
    if (const LuaValue* edges = fields.find("edges")) {
        const std::string& which = text(*edges, fields.location("edges"));
        if (which == "convex")
            keep.edges = KeptEdges::Kind::concave;
        else if (which == "concave")
            keep.edges = KeptEdges::Kind::convex;
        else if (which != "all")
            expected(fields.location("edges"), "'convex', 'concave' or 'all'", *edges);
    }
    if (const LuaValue* regions = fields.find("keep_sharp")) {
        const std::string at = fields.location("keep_sharp");
        const Fields region(*regions, at, {"below", "above", "box"});
        if (const LuaValue* height = region.find("below")) keep.below = number(*height, region.location("below"));
        if (const LuaValue* height = region.find("above")) keep.above = number(*height, region.location("above"));
        if (const LuaValue* box = region.find("box")) {
            const std::string place = region.location("box");
            const LuaTable* corners = as_table(*box);
            if (!corners || corners->list.size() != 2 || !corners->fields.empty())
                expected(place, "two corners, as in {{0, 0, 0}, {1, 1, 1}}", *box);
            const Vec3 a = vector(corners->list[0], place), b = vector(corners->list[1], place);
            keep.boxes.push_back({glm::min(a, b), glm::max(a, b)});
        }
    }
    if (const LuaValue* fade = fields.find("fade")) {
        keep.fade = number_above(*fade, fields.location("fade"), 0);
        if (!keep.any()) throw BadValue(fields.location("fade"), "expected edges or keep_sharp beside it");
    }
    return keep;
}

const std::vector<SceneFunction>& model_functions() {
    static const std::vector<SceneFunction> functions = {{SceneFunction::Kind::global, "model", "", model}};
    return functions;
}

}  // namespace deburr
