// Reads a scene: a Lua chunk that returns a table of solids, lights, camera and picture.
//
// Whatever is wrong with the file, the chunk or its table throws SceneError (lua_sandbox.hpp) with
// one line: `stapler.lua:12: radius: expected a number >= 0, got -0.1`. Not promised: the line of
// a field of the returned table that is written more than once; it may be that of the table.
//
// A camera that follows from the solids' bounds is not placed yet: frame_camera does it, when the picture's shape is
// known.
#pragma once
#include <map>
#include <string>

#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// `defines` are the command line's parameters, each of which the scene must ask for; `model_folders`, where model()
/// looks besides the scene's own.
Scene read_scene(const std::string& file, const std::map<std::string, std::string>& defines = {},
                 const SandboxLimits& limits = {}, const std::vector<std::string>& model_folders = {});

/// The same for a text that is already in memory; `file` is for messages.
Scene read_scene_text(const std::string& text, const std::string& file,
                      const std::map<std::string, std::string>& defines = {}, const SandboxLimits& limits = {},
                      const std::vector<std::string>& model_folders = {});

}  // namespace deburr
