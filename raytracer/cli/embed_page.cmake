# Writes a C++ source that holds the text of INPUT, for scene_page(): cmake -DINPUT=… -DOUTPUT=… -P embed_page.cmake
file(READ "${INPUT}" text)
file(WRITE "${OUTPUT}" "// Made from docs/scenes.md by raytracer/cli/embed_page.cmake.
#include \"raytracer/cli/scene_page.hpp\"

namespace deburr {

std::string_view scene_page() { return R\"page(${text})page\"; }

}  // namespace deburr
")
