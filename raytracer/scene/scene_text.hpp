// Loads the text of a scene's file and prepares it for the interpreter.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace deburr {

/// Most bytes of a scene's file, and of all its files together.
constexpr std::size_t largest_file = std::size_t(16) << 20;

/// The content of the file. Throws SceneError if it cannot be read or is too large.
std::string text_of_file(const std::string& file);

/// The text without a byte order mark, and with a first line that begins with #! made a comment. Throws SceneError,
/// which names `file`, if it is not text.
std::string scene_text(std::string text, const std::string& file);

/// The end of a syntax error's message if the text looks like a model, an OpenSCAD program or a POV-Ray scene rather
/// than Lua; else "". Does not allocate memory.
const char* other_language(std::string_view text);

/// As other_language(), for text that is valid Lua but not a scene, as some OpenSCAD programs are.
const char* other_language_in_lua(std::string_view text);

}  // namespace deburr
