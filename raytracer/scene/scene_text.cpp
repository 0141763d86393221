#include "raytracer/scene/scene_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "raytracer/scene/lua_sandbox.hpp"

namespace deburr {

std::string text_of_file(const std::string& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw SceneError(one_line("expected a scene, got a directory", file));
    const auto close = [](std::FILE* f) { std::fclose(f); };
    const std::unique_ptr<std::FILE, decltype(close)> input(std::fopen(file.c_str(), "rb"), close);
    if (!input) throw SceneError(one_line(std::string("expected a scene, got: ") + std::strerror(errno), file));
    std::string text;
    char buffer[65'536];
    while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, input.get())) {
        text.append(buffer, size);
        if (text.size() > largest_file)
            throw SceneError(
                one_line(fmt::format("expected at most {} MiB of text, got more", largest_file >> 20), file));
    }
    if (std::ferror(input.get()))
        throw SceneError(one_line(std::string("expected a scene, got: ") + std::strerror(errno), file));
    return text;
}

// Refuses text that Lua would silently cut off at a NUL, or report in its own terms.
static void check_text(const std::string& text, const std::string& file) {
    int line = 1;
    for (const char c : text) {
        if (c == '\n') ++line;
        const auto code = static_cast<unsigned char>(c);
        if (code >= ' ' || (c >= '\t' && c <= '\r')) continue;
        throw SceneError(one_line(
            fmt::format("{}:{}: expected text, got binary data (a byte {})", file_mark, line, int(code)), file));
    }
}

std::string scene_text(std::string text, const std::string& file) {
    check_text(text, file);
    if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3);  // byte order mark
    if (text.compare(0, 1, "#") == 0) text.insert(0, "--");         // makes #! a comment, as the lua command does
    return text;
}

static constexpr const char* looks_like_openscad =
    "; this looks like OpenSCAD, which is read from a file that ends in .scad";

const char* other_language(std::string_view text) {
    const auto has = [&](std::string_view word) { return text.find(word) != std::string_view::npos; };
    const auto starts = [&](std::string_view word) { return text.substr(0, word.size()) == word; };
    if (starts("solid") && has("facet")) return "; this looks like STL, which is read from a file that ends in .stl";
    if (starts("ply")) return "; this looks like PLY, which is read from a file that ends in .ply";
    if (starts("OFF")) return "; this looks like OFF, which is read from a file that ends in .off";
    if ((starts("v ") || has("\nv ")) && has("\nf "))
        return "; this looks like OBJ, which is read from a file that ends in .obj";
    for (const char* word : {"#declare", "#include", "location <", "look_at"})
        if (has(word)) return "; this looks like a scene for POV-Ray, which is not read";
    for (const char* word : {"$fn",          "module ",         "use <",           "include <",
                             "difference()", "union()",         "intersection()",  "hull()",
                             "minkowski()",  "linear_extrude(", "rotate_extrude(", "translate([",
                             "rotate([",     "mirror([",        "scale([",         "color([",
                             "cube([",       "square([",        "polygon([",       "polyhedron(",
                             "cylinder(h",   "cylinder(r",      "cylinder(d",      "sphere(r",
                             "sphere(d",     "circle(",         "= [0:",           "=[0:"})
        if (has(word)) return looks_like_openscad;
    return "";
}

const char* other_language_in_lua(std::string_view text) {
    if (text.find("return") != std::string_view::npos) return "";  // every scene has it, and no OpenSCAD program
    // Looks for a line that calls an OpenSCAD function and ignores the result or continues with a block.
    while (!text.empty()) {
        std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
        if (line.empty() || std::string_view(";{}").find(line.back()) == std::string_view::npos) continue;
        for (const std::string_view name :
             {"cube",           "sphere",         "cylinder",   "polyhedron",   "square", "circle",
              "polygon",        "text",           "translate",  "rotate",       "scale",  "mirror",
              "color",          "union",          "difference", "intersection", "hull",   "minkowski",
              "linear_extrude", "rotate_extrude", "offset",     "projection"}) {
            if (line.substr(0, name.size()) != name) continue;
            line.remove_prefix(name.size());
            line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
            if (line.substr(0, 1) == "(") return looks_like_openscad;
            break;
        }
    }
    return "";
}

}  // namespace deburr
