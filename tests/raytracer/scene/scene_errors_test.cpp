// Errors of the scene as a whole: its table, its parameters, its size, and files that are no scenes.
#include <filesystem>
#include <fstream>

#include "catch.hpp"
#include "raytracer/scene/scene_error_case.hpp"

using namespace deburr;

namespace {

std::string file_error(const std::string& file) {
    try {
        read_scene(file);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("the scene's table says what it expects, with the line that writes it") {
    check_error(GENERATE(values<ErrorCase>({
        {"",
         "s.lua: scene: expected the chunk to return a table, return { solids = { … } }, got "
         "nothing"},
        {"\nreturn 5", "s.lua:2: scene: expected the chunk to return a table, return { solids = { … } }, got 5"},
        {"return cube()",
         "s.lua:1: scene: expected the chunk to return a table, return { solids = { … } }, got a "
         "density"},
        {"return {}", "s.lua:1: solids: expected a list of at least one solid, got nothing"},
        {"return { solids = {} }", "s.lua:1: solids: expected a list of at least one solid, got an empty table"},
        {"return { solids = cube() }", "s.lua:1: solids: expected a list of at least one solid, got a density"},
        {"return {\n solids = { cube(), 3 } }", "s.lua:2: solids[2]: expected a solid or a density, got 3"},
        {"return {\n solids = { cube(), nil, cube() } }",
         "s.lua:2: scene.solids: expected a list without holes, got item 3 but no item 2"},
        {"return {\n solid = { cube() } }",
         "s.lua:2: solid: expected one of the fields up, image, camera, lights, background, "
         "environment, ambient, solids, "
         "got 'solid'"},
        {"return { cube() }", "s.lua:1: scene: expected a table of named fields, got {a density}"},
        {"return { [true] = 1 }", "s.lua:1: scene: expected names or 1, 2, … as keys, got true"},
        {"return {\n camera = {\n eye = {1, 0, 0}, target = {1, 0, 0} }, solids = { cube() } }",
         "s.lua:3: camera.target: expected a point other than the eye, got {1, 0, 0}"},
        {"return {\n up = 'x', solids = { cube() } }", "s.lua:2: up: expected 'y' or 'z', got 'x'"},
        {"return { camera = {\n fov = 180 }, solids = { cube() } }",
         "s.lua:2: camera.fov: expected a number of degrees between 0 and 180, got 180"},
        {"return { camera = {\n fov = 0/0 }, solids = { cube() } }",
         "s.lua:2: camera.fov: expected a number of degrees between 0 and 180, got nan"},
        {"return { camera = {\n eye = {0, 0, 2}, target = {0, 0, 0},\n up = {0, 0, 1} }, solids = "
         "{ cube() } }",
         "s.lua:3: camera.up: expected a direction not parallel to the view, got {0, 0, 1}"},
        {"return { camera = {\n up = {0, 0, 0} }, solids = { cube() } }",
         "s.lua:2: camera.up: expected a direction other than {0, 0, 0}, got {0, 0, 0}"},
        {"return { camera = {\n from = {0, 0, 0} }, solids = { cube() } }",
         "s.lua:2: camera.from: expected one of the fields eye, target, up, fov, projection, lens, shift, got 'from'"},
        {"return { camera = 3, solids = { cube() } }",
         "s.lua:1: camera: expected a table of named fields or frame{…}, got 3"},
        {"return { image = {\n width = 0 }, solids = { cube() } }",
         "s.lua:2: image.width: expected a whole number from 1 to 65536, got 0"},
        {"return { image = {\n height = 1.5 }, solids = { cube() } }",
         "s.lua:2: image.height: expected a whole number from 1 to 65536, got 1.5"},
        {"return { image = {\n spp = '4' }, solids = { cube() } }",
         "s.lua:2: image.spp: expected a whole number from 1 to 1048576, got '4'"},
        {"return {\n lights = point_light{ position = {0, 0, 0} }, solids = { cube() } }",
         "s.lua:2: lights: expected a list of lights, got a light"},
        {"return {\n lights = { cube() }, solids = { cube() } }",
         "s.lua:2: lights[1]: expected a light, got a density"},
        {"return {\n background = matte{}, solids = { cube() } }",
         "s.lua:2: background: expected a colour, sky{…} or environment{…}, got a material"},
        {"return {\n ambient = -1, solids = { cube() } }",
         "s.lua:2: ambient: expected a colour, {r, g, b} or a number, >= 0, got -1"},
        {"-- ambient = 0\nlocal s = 'ambient = 1'\nreturn {\n ambient = -1, solids = { cube() } }",
         "s.lua:4: ambient: expected a colour, {r, g, b} or a number, >= 0, got -1"},
        {"local t = {} t.image = t t.solids = { cube() }\nreturn t",
         "s.lua:1: scene.image.image.image.image.image.image.image.image.image.image.image.image: "
         "expected tables nested at most 12 deep, got deeper"},
    })));
}

TEST_CASE("parameters say what they expect") {
    const std::string scene =
        "local r, on, name = param('r', 0.5), param('on', true), param('name', 'x')\n"
        "return { solids = { cube() } }";
    CHECK(error_of(scene, {{"r", "thin"}}) == "s.lua:1: param 'r': expected a number after -D r=, got 'thin'");
    CHECK(error_of(scene, {{"r", "nan"}}) == "s.lua:1: param 'r': expected a number after -D r=, got 'nan'");
    CHECK(error_of(scene, {{"r", ""}}) == "s.lua:1: param 'r': expected a number after -D r=, got ''");
    CHECK(error_of(scene, {{"on", "yes"}}) == "s.lua:1: param 'on': expected true or false after -D on=, got 'yes'");
    CHECK(error_of(scene, {{"radius", "1"}}) ==
          "s.lua: -D radius: expected one of the scene's parameters name, on, r, got 'radius'");
    CHECK(error_of("return { solids = { cube() } }", {{"r", "1"}}) ==
          "s.lua: -D r: expected no parameters, the scene has none");
    CHECK(error_of("param('r')") == "s.lua:1: param 'r': expected a number, boolean or text as default, got nothing");
    CHECK(error_of("param(1, 2)") == "s.lua:1: param: name: expected a text, got 1");
}

TEST_CASE("expressions that grow beyond all bounds are refused at once") {
    CHECK(error_of("local a = cube()\nfor i = 1, 60 do a = a | a end") ==
          "s.lua:2: operator |: expected at most 4000000 half-spaces, got 6291456");
    CHECK(error_of("local a = sharp(cube())\nfor i = 1, 60 do a = a - a end") ==
          "s.lua:2: operator -: expected at most 4000000 half-spaces, got 6291456");
    CHECK(error_of("local a = cube()\nfor i = 1, 19 do a = a + a end\n"
                   "return {\n solids = { a, a } }") ==
          "s.lua:4: solids: expected at most 4000000 half-spaces, got 6291456");
    CHECK(error_of("local t = {}\nfor i = 1, 1000 do t[i] = 0 end\nfor k = 1, 5 do local u = {}\n"
                   "for i = 1, 1000 do u[i] = t end t = u end\nreturn t") ==
          "s.lua:5: expected a scene that needs at most 64 MiB, got one that needs more");
}

TEST_CASE("a file that is no scene says what it is") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "deburr_scene_errors";
    std::filesystem::create_directories(folder);
    CHECK(file_error(folder.string()) == folder.string() + ": expected a scene, got a directory");
    const std::string none = (folder / "none.lua").string();
    CHECK(file_error(none) == none + ": expected a scene, got: No such file or directory");
    const std::string file = (folder / "x.lua").string();
    const auto write = [&](const std::string& text) { std::ofstream(file, std::ios::binary) << text; };
    write("");
    CHECK_THAT(file_error(file), Catch::Matchers::StartsWith(file + ": scene: expected the chunk to return"));
    write(std::string("return {}\n-- \0", 14));
    CHECK(file_error(file) == file + ":2: expected text, got binary data (a byte 0)");
    write("\x1bLuaT");
    CHECK(file_error(file) == file + ":1: expected text, got binary data (a byte 27)");
    write("return {\n  solids = { cube( } }\n");
    CHECK(file_error(file) == file + ":2: unexpected symbol near '}'");
    // A newcomer may save a program of another language under a scene's name.
    const auto looks_like = [&](const std::string& text, const std::string& end) {
        write(text);
        CAPTURE(text);
        CHECK_THAT(file_error(file),
                   Catch::Matchers::StartsWith(file + ":") && Catch::Matchers::EndsWith("; this looks like " + end));
    };
    const std::string scad = "OpenSCAD, which is read from a file that ends in .scad";
    looks_like("// A plate.\n$fn = 50;\ndifference() {\n  cube([9, 9, 1]);\n  cylinder(h = 3, r = 2);\n}\n", scad);
    looks_like("module part(x) { cube([x, 2, 3]); }\npart(4);\n", scad);
    looks_like("cube([10, 10, 10]);\n", scad);
    looks_like("/* Both. */ union() { sphere(r = 3); cube(5); }\n", scad);
    looks_like("cylinder(h = 10, d = 5);\n", scad);
    looks_like("for (i = [0:5]) cube(i);\n", scad);
    // Lua accepts these texts, and finds the mistake later or never.
    looks_like("cube();\n", scad);
    looks_like("cube(10);\n", scad);
    looks_like("w = 5;\n  sphere(w);\n", scad);
    looks_like("difference() { cube(10); sphere(6); }\n", scad);
    looks_like("union()\n{\n  cube(10);\n  sphere(6);\n}\n", scad);
    looks_like("linear_extrude(5) circle(3);\n", scad);
    looks_like("translate(1, 2, 3) cube(2);\n", scad);
    // A scene with an error is still taken for a scene.
    const auto is_lua = [&](const std::string& text) {
        write(text);
        CAPTURE(text);
        CHECK_THAT(file_error(file),
                   Catch::Matchers::StartsWith(file + ":") && !Catch::Matchers::Contains("this looks like"));
    };
    is_lua("local c = cube();\nlocal s = rounded(0.1, c)\n");
    is_lua("cube();\nreturn { solids = { cube(3) } }\n");
    is_lua("local c = cube()\nerror('union of what?')\n");
    is_lua("local n = 5\n");
    looks_like("use <MCAD/boxes.scad>\nroundedBox(2);\n", scad);
    looks_like("solid a\nfacet normal 0 0 1\nouter loop\n", "STL, which is read from a file that ends in .stl");
    looks_like("ply\nformat ascii 1.0\n", "PLY, which is read from a file that ends in .ply");
    looks_like("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "OBJ, which is read from a file that ends in .obj");
    looks_like("camera { location <0, 0, -5> look_at 0 }\n", "a scene for POV-Ray, which is not read");
    std::filesystem::remove_all(folder);
}

TEST_CASE("words of other languages say what to write instead") {
    check_error(GENERATE(values<ErrorCase>({
        {"union(cube(), cube())", "s.lua:1: expected a known name, got 'union'; write a | b"},
        {"difference(cube(), cube())", "s.lua:1: expected a known name, got 'difference'; write a & ~b"},
        {"translate(cube(), 1, 0, 0)", "s.lua:1: expected a known name, got 'translate'; write d:translate(x, y, z)"},
        {"local a = sin(1)", "s.lua:1: expected a known name, got 'sin'; write math.sin, of an angle in radians"},
        {"require('part')", "s.lua:1: require: not available in a scene, use include(\"part.lua\")"},
        {"cube():move(1, 0, 0)",
         "s.lua:1: expected a method (translate, scale, rotate, mirror, radius, material, name), got 'move'; write "
         "d:translate(x, y, z)"},
        {"string.union('a')", "s.lua:1: expected a known name, got 'string.union'"},
        {"cylinder{ h = 10, r = 5 }", "s.lua:1: cylinder.h: expected one of the fields from, to, radius, got 'h'"},
        {"cone{ h = 10 }", "s.lua:1: cone.h: expected one of the fields from, to, radius, got 'h'"},
        {"cylinder{ radius = 5, height = 10 }",
         "s.lua:1: cylinder.height: expected one of the fields from, to, radius, got 'height'"},
        {"local a = cube() ~ cube()", "s.lua:1: operator ~: expected one density, as in a & ~b, got two, as in a ~ b"},
        {"if 1 != 2 then end",
         "s.lua:1: 'then' expected near '!'; Lua writes ~= where others write !=, and not a where others write !a"},
        {"local n = 1\nn += 1", "s.lua:2: syntax error near '+'; Lua writes x = x + 1 where others write x += 1"},
        {"return { solids = { cube() } camera = frame{} }",
         "s.lua:1: '}' expected near 'camera'; is a comma missing there?"},
    })));
}

TEST_CASE("long names of files are not cut in messages") {
    const std::string name = std::string(200, 'x') + ".lua";
    try {
        read_scene_text("\nlocal a = nil + 1", name);
        FAIL();
    } catch (const SceneError& error) {
        CHECK_THAT(error.what(), Catch::Matchers::StartsWith(name + ":2: attempt"));
    }
}

TEST_CASE("work inside the scene's functions counts, though it be done under pcall") {
    const std::string endless =
        "s.lua:2: expected a scene that ends within 20000000 instructions, got one "
        "that does not";
    const std::string list = "local t = {} for i = 1, 10000 do t[i] = {i, i * i % 7, i * i % 11} end\n";
    CHECK(error_of(list + "while true do pcall(cube, t) end") == endless);
    CHECK(error_of(list + "while true do pcall(convex, t) end") == endless);
}
