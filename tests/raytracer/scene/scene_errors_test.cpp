#include <filesystem>
#include <fstream>

#include "catch.hpp"
#include "raytracer/scene/scene_reader.hpp"

using namespace deburr;

namespace {

std::string error_of(const std::string& text, const std::map<std::string, std::string>& defines = {}) {
    try {
        read_scene_text(text, "s.lua", defines, {std::size_t(64) << 20, 20'000'000, 20.0});
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

std::string file_error(const std::string& file) {
    try {
        read_scene(file);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

struct Case {
    const char *text, *error;
};

void check(const Case& c) {
    CAPTURE(c.text);
    CHECK(error_of(c.text) == c.error);
}

}  // namespace

TEST_CASE("shapes say what they expect") {
    check(GENERATE(values<Case>({
        {"halfspace({0, 0, 0}, 1)",
         "s.lua:1: halfspace: normal: expected a direction other than {0, 0, 0}, got {0, 0, 0}"},
        {"halfspace({0, 1}, 1)", "s.lua:1: halfspace: normal: expected three finite numbers {x, y, z}, got {0, 1}"},
        {"halfspace({0, 0/0, 1}, 1)",
         "s.lua:1: halfspace: normal: expected three finite numbers {x, y, z}, got {0, nan, 1}"},
        {"halfspace({0, 1, 0})", "s.lua:1: halfspace: d: expected a finite number, got nothing"},
        {"halfspace({0, 1, 0}, 1/0)", "s.lua:1: halfspace: d: expected a finite number, got inf"},
        {"halfspace({0, 1, 0}, '1')", "s.lua:1: halfspace: d: expected a finite number, got '1'"},
        {"halfspace({0, 1, 0}, 1, 2)", "s.lua:1: halfspace: expected at most 2 arguments, got 3"},
        {"halfspace({1e-200, 0, 0}, 1e200)",
         "s.lua:1: halfspace: expected a normal and a distance of ordinary size, got singular "
         "ones"},
        {"cube(1)", "s.lua:1: cube: expected at most 0 arguments, got 1"},
        {"box({0, 0, 0}, {1, 0, 1})", "s.lua:1: box: expected y0 < y1, got 0 and 0"},
        {"box({0, 0, 2}, {1, 1, 1})", "s.lua:1: box: expected z0 < z1, got 2 and 1"},
        {"box(1, 2)", "s.lua:1: box: lower corner: expected three finite numbers {x, y, z}, got 1"},
        {"convex{ {0,0,0}, {1,0,0}, {0,1,0} }", "s.lua:1: convex: expected at least 4 different points, got 3"},
        {"convex{ {0,0,0}, {1,0,0}, {0,1,0}, {0,0,0} }",
         "s.lua:1: convex: expected at least 4 different points, got 3"},
        {"convex{ {0,0,0}, {1,0,0}, {0,1,0}, {1,1,0}, {3,2,0} }",
         "s.lua:1: convex: expected points that span a volume, got points in one plane"},
        {"convex{ {0,0,0}, {1,1,1}, {2,2,2}, {3,3,3} }",
         "s.lua:1: convex: expected points that span a volume, got points in one plane"},
        {"convex{ {0,0,0}, {1,1} }", "s.lua:1: convex[2]: expected three finite numbers {x, y, z}, got {1, 1}"},
        {"convex(cube())", "s.lua:1: convex: expected a list of points, got a density"},
        {"prism({ {0,0}, {1,0} }, 0, 1)", "s.lua:1: prism: expected a polygon of at least 3 different points, got 2"},
        {"prism({ {0,0}, {1,0}, {2,0} }, 0, 1)",
         "s.lua:1: prism: expected a polygon with an area, got points on one line"},
        {"prism({ {0,0}, {1,0}, {1,1} }, 1, 1)", "s.lua:1: prism: expected low < high, got 1 and 1"},
        {"prism({ {0,0}, {2,2}, {2,0}, {0,2} }, 0, 1)",
         "s.lua:1: prism: expected a polygon that does not meet itself, got sides that cross at (1, 1)"},
        {"prism({ {0,0}, {2,0}, {1,1}, {2,2}, {0,2}, {1,1} }, 0, 1)",
         "s.lua:1: prism: expected a polygon that does not meet itself, got the point (1, 1) twice"},
        {"prism({ {0,0}, {2,0}, {2,2}, {1,0}, {0,2} }, 0, 1)",
         "s.lua:1: prism: expected a polygon that does not meet itself, got the point (1, 0) on another side"},
        {"prism({ {0,0}, {2,0}, {2,1}, {3,1}, {2.5,1}, {2,2} }, 0, 1)",
         "s.lua:1: prism: expected a polygon that does not meet itself, got sides that turn back at (3, 1)"},
        {"prism({ {0,0}, {1,0}, {1,1} }, 0, 1, { axis = 'w' })",
         "s.lua:1: prism: options.axis: expected 'x', 'y' or 'z', got 'w'"},
        {"prism({ {0,0}, {1,0}, {1,1} }, 0, 1, { hole = {} })",
         "s.lua:1: prism: options.hole: expected one of the fields axis, holes, got 'hole'"},
        {"prism({ {0,0}, {1,0}, {1,1} }, 0, 1, { holes = { { {0.5,0.2}, {0.6,0.2} } } })",
         "s.lua:1: prism: options.holes[1]: expected a polygon of at least 3 different points, got 2"},
        {"prism({ {0,0}, {1,0,0}, {1,1} }, 0, 1)", "s.lua:1: prism[2]: expected two numbers {x, z}, got {1, 0, 0}"},
        {"prism({ {0,0}, {1,0}, {1,1} }, 0)", "s.lua:1: prism: high: expected a finite number, got nothing"},
        {"rounded(-0.1, cube())", "s.lua:1: rounded: radius: expected a number >= 0, got -0.1"},
        {"rounded(0/0, cube())", "s.lua:1: rounded: radius: expected a number >= 0, got nan"},
        {"rounded(0.1)", "s.lua:1: rounded: expected a density, got nothing"},
        {"convolved(0, cube())", "s.lua:1: convolved: radius: expected a number > 0, got 0"},
        {"convolved(0.1, rounded(0.1, cube()))",
         "s.lua:1: convolved: expected a density, got a solid, which is rounded already: join densities first, then "
         "round, "
         "as in rounded(r, a | b)"},
        {"convolved(0.1, cube() | ~cube():radius(0.2))",
         "s.lua:1: convolved: expected a density without radii, got one with :radius(); one ball rounds all of it"},
        {"rounded(cube(), 0.1)", "s.lua:1: rounded: radius: expected a number >= 0, got a density"},
        {"sharp(sharp(cube()))",
         "s.lua:1: sharp: expected a density, got a solid, which is rounded already: join densities first, then round, "
         "as in rounded(r, a | b)"},
    })));
}

TEST_CASE("quadrics, perturbations and free forms say what they expect") {
    check(GENERATE(values<Case>({
        {"quadric{ c = 1 }",
         "s.lua:1: quadric: expected a surface: a coefficient besides c that is not 0, got only c = 1"},
        {"quadric{ xx = 0/0 }", "s.lua:1: quadric.xx: expected a finite number, got nan"},
        {"quadric{ yz = 1/0 }", "s.lua:1: quadric.yz: expected a finite number, got inf"},
        {"quadric{ xx = 1e60 }", "s.lua:1: quadric.xx: expected a coefficient of at most 1e+50, got 1e+60"},
        {"quadric{ 1, 2, 3 }", "s.lua:1: quadric: expected ten coefficients (xx yy zz xy xz yz x y z c), got 3"},
        {"quadric{ 1, 1, 1, 0, 0, 0, 0, 0, 0, 0/0 }", "s.lua:1: quadric: c: expected a finite number, got nan"},
        {"quadric{ xq = 1 }",
         "s.lua:1: quadric.xq: expected one of the fields xx, yy, zz, xy, xz, yz, x, y, z, c, got 'xq'"},
        {"quadric()", "s.lua:1: quadric: expected coefficients { xx = … } or a list of ten, got nothing"},
        {"return { solids = { quadric{ xx = -1, yy = -1, zz = -1 } } }",  // a point
         "s.lua:1: quadric: expected a surface, got a quadric that is <= 0 everywhere"},
        {"local line = quadric{ xx = -1, zz = -1, xz = 2, yy = -1 }:rotate(40, {1, 2, 3}) - ellipsoid{}",
         "s.lua:1: quadric: expected a surface, got a quadric that is <= 0 everywhere"},
        {"return { solids = { quadric{ xx = 1, c = 1 } } }",
         "s.lua:1: quadric: expected a surface, got a quadric that is >= 0 everywhere"},
        {"freeform(quadric{ xx = -1, c = -1 }, { perturbation(-2, ellipsoid{}) })",
         "s.lua:1: freeform: expected a surface, got a quadric that is <= 0 everywhere"},
        {"perturbation(1, quadric{ xx = -1, c = -1 })",
         "s.lua:1: perturbation: expected a quadric that is positive somewhere, got one that is <= 0 everywhere"},
        {"ellipsoid{ radius = 0 }", "s.lua:1: ellipsoid.radius: expected a number > 0, got 0"},
        {"ellipsoid{ radii = {1, -1, 1} }", "s.lua:1: ellipsoid.radii: expected three numbers > 0, got {1, -1, 1}"},
        {"ellipsoid{ radius = 1, radii = {1, 1, 1} }", "s.lua:1: ellipsoid: expected radius or radii, got both"},
        {"ellipsoid{ radius = 1e-40 }",
         "s.lua:1: ellipsoid: expected lengths of ordinary size, got such that coefficients overflow"},
        {"local e = ellipsoid{} for i = 1, 5 do e = e:scale(1e-90) end",
         "s.lua:1: scale: expected lengths of ordinary size, got such that coefficients overflow"},
        {"cone{ axis = {0, 0, 0} }", "s.lua:1: cone.axis: expected a direction other than {0, 0, 0}, got {0, 0, 0}"},
        {"cone{ height = -1 }", "s.lua:1: cone.height: expected a number > 0, got -1"},
        {"hyperboloid{ sheets = 3 }", "s.lua:1: hyperboloid.sheets: expected a whole number from 1 to 2, got 3"},
        {"perturbation(0/0, ellipsoid{})", "s.lua:1: perturbation: factor: expected a finite number, got nan"},
        {"perturbation(1, cube())", "s.lua:1: perturbation: expected a quadric, got a density"},
        {"freeform(cube(), {})", "s.lua:1: freeform: expected a quadric, got a density"},
        {"freeform(ellipsoid{})", "s.lua:1: freeform: expected a list of perturbations, got nothing"},
        {"freeform(ellipsoid{}, { ellipsoid{} })", "s.lua:1: freeform[1]: expected a perturbation, got a quadric"},
        {"return { solids = { perturbation(1, ellipsoid{}) } }",
         "s.lua:1: solids[1]: expected a solid or a density, got a perturbation"},
        {"local a = ellipsoid{} + ellipsoid{}",
         "s.lua:1: operator +: expected densities on both sides (solids have | & -), got a quadric"},
        {"rounded(0.1, ellipsoid{})",
         "s.lua:1: rounded: expected a density, got a quadric, which cannot be rounded with others: write sphere{…}, "
         "cylinder{ from =, to = } or cone{ from =, to = }, or join it to rounded solids by | & -"},
        {"sphere{ radius = 0 }", "s.lua:1: sphere.radius: expected a number > 0, got 0"},
        {"sphere(1)", "s.lua:1: sphere: expected a table of fields, got 1"},
        {"sphere{ size = 1 }", "s.lua:1: sphere.size: expected one of the fields center, radius, got 'size'"},
        {"cylinder{ from = {0,0,0} }", "s.lua:1: cylinder.to: expected three finite numbers {x, y, z}, got nothing"},
        {"cylinder{ from = {0,1,0}, to = {0,1,0} }",
         "s.lua:1: cylinder: expected two ends, from and to, that are apart, got the same point twice"},
        {"cylinder{ from = {0,0,0}, to = {0,1,0}, axis = {0,1,0} }",
         "s.lua:1: cylinder.axis: expected one of the fields from, to, radius, got 'axis'"},
        {"cone{ from = {0,0,0}, to = {0,1,0}, radius = 1 }",
         "s.lua:1: cone.radius: expected two radii {at from, at to}, got 1"},
        {"cone{ from = {0,0,0}, to = {0,1,0}, radius = {0, 0} }",
         "s.lua:1: cone.radius: expected two radii that are not both 0, got {0, 0}"},
        {"torus{ radius = 1, tube = 2 }",
         "s.lua:1: torus: expected a tube that is at most the radius, so that the hole stays open, got 2 > 1"},
        {"torus{ tube = 2 }", "s.lua:1: torus.radius: expected a number > 0, got nothing"},
        {"rounded(0.6, torus{ radius = 1, tube = 0.5 })",
         "s.lua:1: rounded: expected a torus whose radius is at least its tube and the rounding radius, got 1 < 0.5 + "
         "0.6"},
        {"convolved(0.1, ~sphere{})",
         "s.lua:1: convolved: expected a bounded density, as this one has round parts; cut it off with box(lo, hi)"},
        {"convolved(0.1, sphere{}:radius(0.1))",
         "s.lua:1: convolved: expected a density without radii, got one with :radius(); one ball rounds all of it"},
        {"sphere{}:scale(1, 2, 1)",
         "s.lua:1: scale: expected one factor for a density with round parts, got several; scale the rounded solid, as "
         "in rounded(r, d):scale(x, y, z)"},
        {"rounded(0.1, rounded(0.1, cube()))",
         "s.lua:1: rounded: expected a density, got a solid, which is rounded already: join densities first, then "
         "round, "
         "as in rounded(r, a | b)"},
    })));
}

TEST_CASE("a star, which turns one way, meets itself") {
    const std::string star =
        "local p = {} for i = 0, 4 do p[i + 1] = {math.cos(i * 0.8 * math.pi), math.sin(i * 0.8 * "
        "math.pi)} end\n";
    CHECK(error_of(star + "prism(p, 0, 1)")
              .find("s.lua:2: prism: expected a polygon that does not meet itself, got sides "
                    "that cross at (") == 0);
}

TEST_CASE("operators and methods say what they expect") {
    check(GENERATE(values<Case>({
        {"\nlocal a = cube() + 1", "s.lua:2: operator +: expected densities on both sides (solids have | & -), got 1"},
        {"local a = sharp(cube()) * cube()",
         "s.lua:1: operator *: expected densities on both sides (solids have | & -), got a solid"},
        {"local a = {} | cube()",
         "s.lua:1: operator |: expected densities or solids on both sides, got an empty table"},
        {"local a = cube() - matte{}",
         "s.lua:1: operator -: expected densities or solids on both sides, got a material"},
        {"local a = ~sharp(cube())", "s.lua:1: operator ~: expected a density, got a solid"},
        {"cube():radius(-0.1)", "s.lua:1: radius: expected a number >= 0, got -0.1"},
        {"sharp(cube()):radius(0.1)",
         "s.lua:1: radius: expected a density, got a solid, which is rounded already: join densities first, then "
         "round, "
         "as in rounded(r, a | b)"},
        {"cube():radious(0.1)",
         "s.lua:1: expected a method (translate, scale, rotate, mirror, radius, material, name), "
         "got "
         "'radious'"},
        {"cube().translate(1, 2, 3)", "s.lua:1: translate: expected a density or a solid, got 1"},
        {"cube():translate(1, 2)", "s.lua:1: translate: z: expected a finite number, got nothing"},
        {"cube():scale(0)", "s.lua:1: scale: expected a factor that leaves a volume, for 0 is singular, got 0"},
        {"cube():scale(1, 0, 1)",
         "s.lua:1: scale: y: expected a factor that leaves a volume, for 0 is singular, got 0"},
        {"cube():scale(1, 2)", "s.lua:1: scale: z: expected a finite number, got nothing"},
        {"cube():scale(1/0)", "s.lua:1: scale: expected a finite number, got inf"},
        {"cube():rotate(90)", "s.lua:1: rotate: axis: expected three finite numbers {x, y, z}, got nothing"},
        {"cube():rotate(90, {0, 0, 0})",
         "s.lua:1: rotate: axis: expected a direction other than {0, 0, 0}, got {0, 0, 0}"},
        {"cube():mirror({0, 0, 0})",
         "s.lua:1: mirror: normal: expected a direction other than {0, 0, 0}, got {0, 0, 0}"},
        {"cube():material('red')", "s.lua:1: material: expected a material, got 'red'"},
        {"cube():material({color = 1})", "s.lua:1: material: expected a material, got a table with names"},
        {"matte{}:material(matte{})", "s.lua:1: material: expected a density or a solid, got a material"},
        {"cube():name(print)", "s.lua:1: name: expected a text, got a function"},
        {"local a = cube() .. 'x'", "s.lua:1: attempt to concatenate a userdata value"},
    })));
}

TEST_CASE("materials, textures and lights say what they expect") {
    check(GENERATE(values<Case>({
        {"plastik{ color = 1 }", "s.lua:1: expected a known name, got 'plastik', did you mean plastic?"},
        {"plastic{ colour = 1 }",
         "s.lua:1: plastic.colour: expected one of the fields color, roughness, ior, emission, bump, bump_height, "
         "got 'colour'"},
        {"matte{ {1, 0, 0} }", "s.lua:1: matte: expected a table of named fields, got a list of 1"},
        {"matte(0.5)", "s.lua:1: matte: expected a table of named fields, got 0.5"},
        {"matte{ color = 2 }", "s.lua:1: matte.color: expected a colour, {r, g, b} or a number, from 0 to 1, got 2"},
        {"matte{ color = {1, 1, -1} }",
         "s.lua:1: matte.color: expected a colour, {r, g, b} or a number, from 0 to 1, got {1, 1, "
         "-1}"},
        {"matte{ color = matte{} }", "s.lua:1: matte.color: expected a colour or a texture, got a material"},
        {"metal{ roughness = -1 }", "s.lua:1: metal.roughness: expected a number from 0 to 1, got -1"},
        {"glass{ ior = 0.5 }", "s.lua:1: glass.ior: expected a number from 1 to 10, got 0.5"},
        {"checker{ scale = 0 }", "s.lua:1: checker.scale: expected a number > 0, got 0"},
        {"checker{ axis = {1, 0, 0} }",
         "s.lua:1: checker.axis: expected one of the fields a, b, scale, origin, got 'axis'"},
        {"wood{ axis = {0, 0, 0} }", "s.lua:1: wood.axis: expected a direction other than {0, 0, 0}, got {0, 0, 0}"},
        {"point_light{}", "s.lua:1: point_light.position: expected three finite numbers {x, y, z}, got nothing"},
        {"point_light{ position = {1, 2, 3}, power = -1 }",
         "s.lua:1: point_light.power: expected a number >= 0, got -1"},
        {"directional_light{ direction = {0, 0, 0} }",
         "s.lua:1: directional_light.direction: expected a direction other than {0, 0, 0}, got {0, "
         "0, 0}"},
        {"area_light{ position = {0, 1, 0}, u = {1, 0, 0}, v = {2, 0, 0} }",
         "s.lua:1: area_light.v: expected a side that spans an area with u, got {2, 0, 0}"},
        {"area_light{ position = {0, 1, 0}, u = {1, 0, 0}, v = {0, 0, 1}, samples = 1.5 }",
         "s.lua:1: area_light.samples: expected a whole number from 1 to 4096, got 1.5"},
        {"sky{ horizon = -1 }", "s.lua:1: sky.horizon: expected a colour, {r, g, b} or a number, >= 0, got -1"},
    })));
}

TEST_CASE("the scene's table says what it expects, with the line that writes it") {
    check(GENERATE(values<Case>({
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
    // What a newcomer has, under the name of a scene.
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
    // Lua reads these, and finds the mistake later or never.
    looks_like("cube();\n", scad);
    looks_like("cube(10);\n", scad);
    looks_like("w = 5;\n  sphere(w);\n", scad);
    looks_like("difference() { cube(10); sphere(6); }\n", scad);
    looks_like("union()\n{\n  cube(10);\n  sphere(6);\n}\n", scad);
    looks_like("linear_extrude(5) circle(3);\n", scad);
    looks_like("translate(1, 2, 3) cube(2);\n", scad);
    // A scene that is wrong is still a scene, whatever it is about.
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
    check(GENERATE(values<Case>({
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
