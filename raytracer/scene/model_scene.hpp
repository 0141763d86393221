// A scene that is made around a model file, where one stands in place of a scene.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytracer/scene/keep_sharp.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

struct ModelSettings {
    double round = 0;           // the rounding radius, in the file's units; 0: as it stands
    KeepSharp keep;             // what is not rounded
    std::optional<bool> z_up;   // none: GLB and glTF have y up, all others z
    std::optional<Vec3> color;  // of its material
    std::string material;       // "plastic", …; empty: plastic
    bool ground = true;         // it stands on a floor
};

/// Names that ModelSettings::material takes.
const std::vector<std::string>& model_materials();

/// The model, rounded, on a ground, with a camera that frames it and soft light. Throws what read_model throws.
Scene model_scene(const std::string& path, const ModelSettings& settings = {});

}  // namespace deburr
