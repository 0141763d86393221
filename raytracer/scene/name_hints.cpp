#include "raytracer/scene/name_hints.hpp"

namespace deburr {
namespace {

struct Hint {
    const char *name, *instead;
};

// Names from OpenSCAD, from other scene languages, and from Lua's math without its prefix, none of which a scene has.
constexpr Hint hints[] = {
    {"union", "; write a | b"},
    {"unite", "; write a | b"},
    {"join", "; write a | b"},
    {"add", "; write a | b"},
    {"difference", "; write a & ~b"},
    {"subtract", "; write a & ~b"},
    {"cut", "; write a & ~b"},
    {"intersection", "; write a & b"},
    {"intersect", "; write a & b"},
    {"translate", "; write d:translate(x, y, z)"},
    {"move", "; write d:translate(x, y, z)"},
    {"rotate", "; write d:rotate(degrees, {x, y, z})"},
    {"scale", "; write d:scale(factor)"},
    {"hull", "; write convex{ points }"},
    {"pyramid", "; write convex{ points }"},
    {"polyhedron", "; write convex{ points }, or model(\"part.stl\")"},
    {"minkowski", "; write rounded(radius, d)"},
    {"round", "; write rounded(radius, d)"},
    {"fillet", "; write rounded(radius, d)"},
    {"chamfer", "; write rounded(radius, d)"},
    {"color", "; write s:material(plastic{ color = {r, g, b} })"},
    {"colour", "; write s:material(plastic{ color = {r, g, b} })"},
    {"polygon", "; write prism(points, low, high)"},
    {"square", "; write prism(points, low, high)"},
    {"extrude", "; write prism(points, low, high)"},
    {"linear_extrude", "; write prism(points, low, high)"},
    {"circle", "; write cylinder{ from =, to =, radius = }"},
    {"ball", "; write sphere{ radius = }"},
    {"ring", "; write torus{ radius =, tube = }"},
    {"text", "; write a prism for each letter, as scenes/examples/letters.lua"},
    {"import", "; write model(\"part.stl\"), or include(\"part.lua\")"},
    {"require", ", use include(\"part.lua\")"},
    {"dofile", ", use include(\"part.lua\")"},
    {"light", "; there are point_light, directional_light, area_light and sphere_light"},
    {"camera", "; it is a field of the table that a scene returns"},
    {"pi", "; write math.pi"},
    {"sin", "; write math.sin, of an angle in radians"},
    {"cos", "; write math.cos, of an angle in radians"},
    {"tan", "; write math.tan, of an angle in radians"},
    {"sqrt", "; write math.sqrt"},
    {"abs", "; write math.abs"},
    {"min", "; write math.min"},
    {"max", "; write math.max"},
    {"floor", "; write math.floor"},
};

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

}  // namespace

const char* instead_of_name(std::string_view name) {
    for (const Hint& hint : hints)
        if (name == hint.name) return hint.instead;
    return "";
}

const char* instead_of_syntax(std::string_view message) {
    if (has(message, "near '!'")) return "; Lua writes ~= where others write !=, and not a where others write !a";
    if (has(message, "near '+'")) return "; Lua writes x = x + 1 where others write x += 1";
    if (has(message, "'}' expected")) return "; is a comma missing there?";
    return "";
}

}  // namespace deburr
