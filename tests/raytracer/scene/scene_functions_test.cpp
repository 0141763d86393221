// Errors of the scene language's functions, operators and methods.
#include "raytracer/scene/scene_functions.hpp"

#include "catch.hpp"
#include "raytracer/scene/scene_error_case.hpp"

using namespace deburr;

TEST_CASE("shapes say what they expect") {
    check_error(GENERATE(values<ErrorCase>({
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
    check_error(GENERATE(values<ErrorCase>({
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
    check_error(GENERATE(values<ErrorCase>({
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
    check_error(GENERATE(values<ErrorCase>({
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
