// Where a scene's text names a field: tables do not remember their lines.
#pragma once
#include <string>

namespace deburr {

/// The line that writes the field `location`, such as "camera.fov" or "solids[3]": the only `fov =`,
/// else the only `camera =`, else the last `return`; 0 if there is none of these.
int line_of(const std::string& text, const std::string& location);

}  // namespace deburr
