// Reads a scene: a Lua program that returns a table of solids, lights, camera and picture.
//
// Whatever is wrong with the file, the program or its table throws SceneError with one line, such as `stapler.lua:12:
// radius: expected a number >= 0, got -0.1`. Not promised: the line for a field of the returned table whose name is
// written more than once; it may be that of the table.
//
// A camera that follows from the solids' bounds is not placed yet: frame_camera() does that once the picture's shape is
// known.
#pragma once
#include <map>
#include <string>

#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Reads the scene in a file. `defines` are the command line's parameters, all of which the scene must ask for;
/// `model_folders` are searched for files after the scene's own folder. Throws SceneError, UnsupportedError and
/// std::bad_alloc.
Scene read_scene(const std::string& file, const std::map<std::string, std::string>& defines = {},
                 const SandboxLimits& limits = {}, const std::vector<std::string>& model_folders = {});

/// Reads a scene from text in memory; `file` is its path for messages and for finding other files.
Scene read_scene_text(const std::string& text, const std::string& file,
                      const std::map<std::string, std::string>& defines = {}, const SandboxLimits& limits = {},
                      const std::vector<std::string>& model_folders = {});

}  // namespace deburr
