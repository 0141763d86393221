# Writes a C++ source that holds the text of INPUT, for view_page(): cmake -DINPUT=… -DOUTPUT=… -P embed_page.cmake
# CMake's lists would swallow semicolons of a text that is split; it is kept in one piece.
file(READ "${INPUT}" text)
file(WRITE "${OUTPUT}" "// Made from raytracer/view/view_page.html by raytracer/view/embed_page.cmake.
#include \"raytracer/view/view_server.hpp\"

namespace deburr {

std::string_view view_page() { return R\"page(${text})page\"; }

}  // namespace deburr
")
