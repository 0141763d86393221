// Finds the line of a scene's text that writes a field, since Lua tables do not remember lines.
#pragma once
#include <string>

namespace deburr {

/// The line that writes the field `location`, such as "camera.fov" or "solids[3]": that of the only `fov =`, else of
/// the only `camera =`, else of the last `return`; 0 if there is none of these.
int line_of(const std::string& text, const std::string& location);

}  // namespace deburr
