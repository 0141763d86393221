// The text of a scene's file, as the interpreter takes it.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace deburr {

/// What a scene's files may hold, each of them and all together.
constexpr std::size_t largest_file = std::size_t(16) << 20;

/// All that the file holds. Throws SceneError where it cannot be read or is too large.
std::string text_of_file(const std::string& file);

/// The text without byte order mark, and with a first line that begins with #! made a comment. `file` is for messages:
/// throws SceneError where it is no text.
std::string scene_text(std::string text, const std::string& file);

/// A half-sentence for the message of a syntax error where the text looks like a model, a program for OpenSCAD or a
/// scene for POV-Ray rather than Lua; else an empty one. It allocates nothing.
const char* other_language(std::string_view text);

/// The same for a text that Lua can read and that is no scene all the same: some programs for OpenSCAD are such.
const char* other_language_in_lua(std::string_view text);

}  // namespace deburr
