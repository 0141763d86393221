// Makes a scene around a model's file, for commands that are given a model instead of a scene.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytracer/scene/keep_sharp.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Options for the model and its scene.
struct ModelSettings {
    double round = 0;           // rounding radius in the file's units; 0: none
    KeepSharp keep;             // what stays sharp
    std::optional<bool> z_up;   // none: y for GLB and glTF, z for all others
    std::optional<Vec3> color;  // of its material; none: the default
    std::string material;       // "plastic" etc. (model_materials); empty: plastic
    bool ground = true;         // whether it stands on a floor
};

/// The names that ModelSettings::material may have.
const std::vector<std::string>& model_materials();

/// The model, rounded, on the ground, with a camera that frames it and soft light. Throws as read_model() does.
Scene model_scene(const std::string& path, const ModelSettings& settings = {});

}  // namespace deburr
