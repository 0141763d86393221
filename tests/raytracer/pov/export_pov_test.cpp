// `deburr export-pov`: its formulas have the densities' values, its bounds on their slope hold, and POV-Ray, if it is
// installed, sees the same shapes.
#include <cstdlib>
#include <lua.hpp>
#include <memory>

#include "bounds/bounding_box.hpp"
#include "bounds/decision_diagram.hpp"
#include "catch.hpp"
#include "plain_round.hpp"
#include "random_case.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/pov/pov_field.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// Evaluates a formula for POV-Ray, which is also a Lua expression.
class Formula {
public:
    explicit Formula(const std::string& text) : lua_(luaL_newstate(), lua_close) {
        const std::string program =
            "local sqrt = ... local function pow(a, b) return a^b end "
            "local function Rho(a) if a <= -1 then return 1 elseif a >= 1 then return 0 end "
            "return 0.5 + a*(a*a - 3)*0.25 end "
            "return function(x, y, z) return " +
            text + " end";
        luaL_requiref(lua_.get(), "math", luaopen_math, 1);
        REQUIRE(luaL_loadstring(lua_.get(), program.c_str()) == LUA_OK);
        lua_getglobal(lua_.get(), "math");
        lua_getfield(lua_.get(), -1, "sqrt");
        lua_remove(lua_.get(), -2);
        REQUIRE(lua_pcall(lua_.get(), 1, 1, 0) == LUA_OK);
    }
    double at(Vec3 x) {
        lua_pushvalue(lua_.get(), -1);
        for (int k = 0; k < 3; ++k) lua_pushnumber(lua_.get(), x[k]);
        REQUIRE(lua_pcall(lua_.get(), 3, 1, 0) == LUA_OK);
        const double value = lua_tonumber(lua_.get(), -1);
        lua_pop(lua_.get(), 1);
        return value;
    }

private:
    std::unique_ptr<lua_State, decltype(&lua_close)> lua_;
};

const Density cube = Density::box(Vec3(0.0), Vec3(1.0));
const Density pit = Density::box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75});
const Density below_top = Density::half_space({0, 1, 0}, 1);

bool has_povray() {
    if (std::system("command -v povray >/dev/null 2>&1") == 0) return true;
    WARN("povray is not installed");
    return false;
}

// True for the pixels that red solids cover before a green background.
std::vector<bool> covered(const std::string& png) {
    const PictureFile picture = read_back(png);
    std::vector<bool> mask;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) mask.push_back(picture.at(x, y, 0) < 0.5);
    return mask;
}

// Renders the solid by Deburr and by POV-Ray; returns the number of pixels that only one of them covers, divided by the
// number that Deburr covers. POV-Ray gets what export-pov makes of `exported` with the options; of the solid where it
// is empty.
double mismatch(const std::string& solid, const std::vector<std::string>& options = {},
                const std::string& exported = {}) {
    const Folder folder;
    const auto write_scene = [&](const char* name, const std::string& text) {
        write_file(folder / name, R"(
local pit = box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75})
return {
  image = { width = 160, height = 120 },
  camera = { eye = {1.9, 2.8, 3}, target = {0.5, 0.5, 0.5}, up = {0.1, 1, 0}, fov = 28 },
  lights = { point_light{ position = {4, 6, 3}, power = 400 } },
  background = {0, 1, 0},
  solids = { (()" + text + R"()):material(matte{ color = {1, 0, 0} }) },
})");
    };
    write_scene("s.lua", solid);
    write_scene("exported.lua", exported.empty() ? solid : exported);
    const auto call = [&](std::vector<std::string> words) {
        const Outcome outcome = run(words);
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
    };
    call({"render", folder / "s.lua", "-q", "--spp", "1", "-o", folder / "ours.png"});
    std::vector<std::string> words{"export-pov", folder / "exported.lua", "-q", "-o", folder / "s.pov"};
    words.insert(words.end(), options.begin(), options.end());
    call(words);
    const std::string povray =
        "cd '" + (folder / ".") + "' && povray +W160 +H120 -D -A +WT1 +Otheirs.png s.pov >log 2>&1";
    const int code = std::system(povray.c_str());
    INFO(read_file(folder / "log"));
    REQUIRE(code == 0);
    const std::vector<bool> a = covered(folder / "ours.png"), b = covered(folder / "theirs.png");
    REQUIRE(a.size() == b.size());
    double on = 0, differ = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        on += a[i];
        differ += a[i] != b[i];
    }
    CHECK(on > 1500);
    return differ / on;
}

}  // namespace

TEST_CASE("a formula for POV-Ray has the density's value everywhere") {
    int varying = 0;
    for (const auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = flatten(g.chance(0.5) ? g.boolean(2) : g.arithmetic(2), g.between(0.05, 0.6));
        bool sharp = false;
        for (const HalfSpace& h : tree.half_spaces) sharp |= h.radius == 0;
        if (sharp) continue;
        Formula formula(PovField(tree).formula());
        for (int i = 0; i < 20; ++i) {
            const Vec3 x = g.near(tree);
            const double rho = tree.at(x);
            varying += rho > 0.01 && rho < 0.99;
            CHECK(std::abs(formula.at(x) - rho) < 1e-9);
        }
    }
    CHECK(varying > 300);
}

TEST_CASE("a formula for POV-Ray has the value of round parts, and their slope is bounded", "[slow]") {
    int varying = 0;
    for (const auto seed : seeds(150)) {
        CAPTURE(seed);
        Gen g(seed);
        const RoundCase c = RoundGen(g, g.between(0.05, 0.5)).make(1 + g.below(3));
        const DensityTree tree = flatten(c.density, c.radius);
        const PovField field(tree);
        Formula formula(field.formula());
        const double most = seed % 5 == 0 ? field.greatest_slope({Vec3(-1), Vec3(1)}) : infinity;
        for (int i = 0; i < 20; ++i) {
            const Vec3 x = g.point(1);
            const double rho = c.plain.density(x, c.radius);
            varying += rho > 0.01 && rho < 0.99;
            CHECK(std::abs(formula.at(x) - rho) < 1e-8);
            CHECK(glm::length(tree.gradient_at(x).gradient) <= most + 1e-9);
        }
    }
    CHECK(varying > 300);
}

TEST_CASE("POV-Ray sees the silhouettes of round parts, rounded and sharp", "[slow]") {
    if (!has_povray()) return;
    for (const char* form : {"rounded(0.08, ", "sharp("})
        for (const char* density : {"cylinder{ from = {0.5, 0, 0.5}, to = {0.5, 1, 0.5}, radius = 0.4 } & ~cylinder{ "
                                    "from = {0.5, -1, 0.5}, to = "
                                    "{0.5, 2, 0.5}, radius = 0.2 })",
                                    "cone{ from = {0.5, 0, 0.5}, to = {0.9, 1.1, 0.5}, radius = {0.45, 0} })",
                                    "cone{ from = {0.5, 0, 0.5}, to = {0.5, 1, 0.2}, radius = {0.2, 0.5} })",
                                    "torus{ center = {0.5, 0.5, 0.5}, axis = {1, 2, 1}, radius = 0.5, tube = 0.2 })",
                                    "cube() & ~sphere{ center = {1, 1, 1}, radius = 0.6 })"}) {
            const std::string solid = std::string(form) + density;
            CAPTURE(solid);
            CHECK(mismatch(solid) < 0.005);
        }
}

TEST_CASE("no slope is steeper than what is proved for POV-Ray", "[slow]") {
    for (const auto seed : seeds(100)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = flatten(g.chance(0.5) ? g.boolean(2) : g.arithmetic(2), g.between(0.05, 0.6));
        bool sharp = false;
        for (const HalfSpace& h : tree.half_spaces) sharp |= h.radius == 0;
        if (sharp) continue;
        const double most = PovField(tree).greatest_slope({Vec3(-1.5), Vec3(1.5)});
        for (int i = 0; i < 200; ++i) CHECK(glm::length(tree.gradient_at(g.point(1.4)).gradient) <= most + 1e-12);
    }
}

TEST_CASE("the slope that is proved is nearly that of a face") {
    for (const Density& density : {cube, cube - below_top * pit, cube & ~pit}) {
        const DensityTree tree = flatten(density, 0.1);
        CAPTURE(PovField(tree).formula());
        const double steepest = PovField(tree).greatest_slope(bounding_box(tree));
        CHECK(steepest >= 0.75 / 0.1);
        CHECK(steepest < 1.25 * 0.75 / 0.1);
    }
}

TEST_CASE("POV-Ray sees the silhouettes that Deburr sees", "[slow]") {
    if (!has_povray()) return;
    for (const char* solid :
         {"rounded(0.1, cube() - halfspace({0, 1, 0}, 1) * pit)",
          "rounded(0.1, (cube() & ~pit) | box({0.8, 0, 0.3}, {1.4, 0.3, 0.8}))",
          "rounded(0.07, cube() + box({0.25, 1, 0.25}, {0.75, 1.5, 0.75})):rotate(33, {1, 2, 3}):scale(1, 0.7, 1)",
          "rounded(0.15, cube()) - rounded(0.05, pit)",
          "rounded(0.15, cube()) & rounded(0.1, box({0.2, -1, -1}, {2, 0.9, 0.8})) | rounded(0.1, box({0, 0, 0}, {0.3, "
          "1.2, 0.3}))",
          "rounded(0.2, cube():radius(0.05) * halfspace({1, 1, 1}, 2.2) * halfspace({1, 0, -1}, 0.4):radius(0))",
          "rounded(0.1, convex{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0.4, 1, 0.4}})",
          "sharp(convex{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0.4, 1, 0.4}}) - sharp(box({0.3, 0.2, 0}, {2, 0.5, 0.3}))",
          "sharp(cube():rotate(30, {1, 1, 0})) - sharp(cube():rotate(50, {0, 1, 0}):scale(0.6):translate(0.4, 0.5, "
          "0.4))"}) {
        CAPTURE(solid);
        CHECK(mismatch(solid) < 0.005);
    }
    CHECK(mismatch("rounded(0.1, cube() - halfspace({0, 1, 0}, 1) * pit)", {"--min-max"}) < 0.005);
}

TEST_CASE("POV-Ray's radiosity is as bright as the path tracer") {
    if (!has_povray()) return;
    const Folder folder;
    // A court with white walls under an even sky and a sun: most of the light that the camera sees came by way of a
    // wall.
    write_file(folder / "s.lua", R"(
local court = box({0, 0, 0}, {3, 1.5, 3}) & ~box({0.3, 0.3, 0.3}, {2.7, 2, 2.7})
return {
  image = { width = 80, height = 60 },
  camera = { eye = {4, 5.5, 6}, target = {1.5, 0.6, 1.5}, fov = 30 },
  lights = { directional_light{ direction = {-2, -3, -1}, power = 1.5 } },
  background = {0.5, 0.6, 0.7},
  solids = { sharp(court):material(matte{ color = {0.8, 0.8, 0.8} }) },
})");
    REQUIRE(run({"render", folder / "s.lua", "-q", "--spp", "64", "-o", folder / "ours.png"}).code == 0);
    REQUIRE(run({"export-pov", folder / "s.lua", "--radiosity", "-o", folder / "s.pov"}).code == 0);
    const std::string povray =
        "cd '" + (folder / ".") + "' && povray +W80 +H60 -D +A0.1 +WT1 +Otheirs.png s.pov >log 2>&1";
    const int code = std::system(povray.c_str());
    INFO(read_file(folder / "log"));
    REQUIRE(code == 0);
    // Compares the total linear light of the pixels in the middle of the picture, away from silhouettes.
    const PictureFile ours = read_back(folder / "ours.png"), theirs = read_back(folder / "theirs.png");
    const auto light = [](const PictureFile& picture, int x, int y) { return std::pow(picture.at(x, y, 0), 2.2); };
    double sum = 0, sum_theirs = 0;
    for (int y = 20; y < 40; ++y)
        for (int x = 25; x < 55; ++x) {
            sum += light(ours, x, y);
            sum_theirs += light(theirs, x, y);
        }
    CHECK(sum > 60);
    CHECK(sum_theirs == Approx(sum).epsilon(0.04));
}

TEST_CASE("export-pov --sharp is the scene with every radius 0") {
    if (!has_povray()) return;
    const Folder folder;
    write_file(folder / "s.lua",
               "return { solids = { rounded(0.2, cube() - halfspace({0, 1, 0}, 1) * box({0.25, 0.8, 0.25}, {0.75, 1.8, "
               "0.75})) } }");
    REQUIRE(run({"export-pov", folder / "s.lua", "--sharp", "-o", folder / "s.pov"}).code == 0);
    const std::string text = read_file(folder / "s.pov");
    INFO(text);
    CHECK(text.find("isosurface") == std::string::npos);
    // The clip is the cube's own top; without it no two faces coincide.
    CHECK(text.find("box { <0.25, 0.8, 0.25>, <0.75, 1.8, 0.75> }") != std::string::npos);
    const std::string solid = "cube() - halfspace({0, 1, 0}, 1) * pit)";
    CHECK(mismatch("rounded(0, " + solid, {"--sharp"}, "rounded(0.2, " + solid) < 0.005);
    CHECK(mismatch("rounded(0.2, " + solid, {"--sharp"}) > 0.005);
}

TEST_CASE("export-pov refuses what it cannot do, and writes nothing") {
    const Folder folder;
    write_file(folder / "s.lua", "return { solids = { rounded(0.1, cube()) } }");
    for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                  {"-o", "a.obj"},
                                                  {"-o", "a.pov", "--max-gradient", "0"},
                                                  {"-o", "a.pov", "--accuracy", "x"},
                                                  {"-o", "a.pov", "--sharp", "--accuracy", "1"},
                                                  {"-o", "a.pov", "--sharp", "--min-max"}}) {
        std::vector<std::string> all{"export-pov", folder / "s.lua"};
        for (const std::string& word : words) all.push_back(word == "a.pov" ? folder / word : word);
        CHECK(run(all).code == 2);
    }
    // Sixteen tilted blocks around one point: the decision diagram is too large for a formula.
    write_file(folder / "t.lua", R"(
local d = cube()
for i = 1, 15 do d = d | cube():rotate(11 * i, {i, 1, 3}) & ~box({0, 0, 0}, {0.1, 2, 0.1}):rotate(7 * i, {1, i, 2}) end
return { solids = { rounded(0.3, d) } })");
    const Outcome outcome = run({"export-pov", folder / "t.lua", "-o", folder / "t.pov"});
    CHECK(outcome.code == 3);
    CHECK(outcome.err.find("line 4") != std::string::npos);
    write_file(folder / "t.lua", "return { solids = { convolved(0.1, cube()) } }");
    CHECK(run({"export-pov", folder / "t.lua", "-o", folder / "t.pov"}).code == 3);
    CHECK(folder.names() == std::vector<std::string>{"s.lua", "t.lua"});
}
