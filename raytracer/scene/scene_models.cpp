// Models in a scene: closed meshes from files.
#include <fmt/format.h>

#include "bounds/mesh_field.hpp"
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

Solid SceneBuilder::solid(const PlacedModel& model, double radius, int line) {
    ClosedMeshPtr mesh = model.mesh;
    if (model.map.linear != Mat3(1.0) || model.map.shift != Vec3(0.0)) mesh = transformed(*mesh, model.map);
    return Solid::of_field(std::make_shared<MeshField>(std::move(mesh), radius), line);
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

const std::vector<SceneFunction>& model_functions() {
    static const std::vector<SceneFunction> functions = {{SceneFunction::Kind::global, "model", "", model}};
    return functions;
}

}  // namespace deburr
