// docs/scenes.md against the program: every function, field and argument, the values it takes, and its default.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "bounds/free_form.hpp"
#include "catch.hpp"
#include "closed_shapes.hpp"
#include "docs/page.hpp"
#include "raytracer/folder.hpp"
#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/scene_functions.hpp"
#include "raytracer/scene/scene_reader.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

std::string error_of(const std::string& scene) {
    static const Folder models;  // in the place of the folder of the page's files
    write_file(models / "bracket.stl", Shape::l_prism().stl());
    write_file(models / "planks.png", "a picture");  // read only when rendering
    try {
        read_scene_text(scene, "s.lua", {}, {}, {models / ""});
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// True if the heading is the function's: it begins with "matte{", "rounded(", "x:translate(" or "d:radius(", or has the
// operator's sign.
bool is_heading_of(const SceneFunction& function, const std::string& heading) {
    const std::string name = function.name;
    switch (function.kind) {
        case SceneFunction::Kind::global: return heading.rfind(name + "(", 0) == 0 || heading.rfind(name + "{", 0) == 0;
        case SceneFunction::Kind::method: return heading.substr(1).rfind(":" + name + "(", 0) == 0;
        case SceneFunction::Kind::metamethod: break;
    }
    const char sign = name.back();
    return heading == fmt::format("a {} b", sign) || heading == fmt::format("{}a", sign);
}

/// A table of named fields on the page, and a scene in which its fields can be put.
struct FieldTable {
    std::string owner;  // as "matte" or "camera"; "" for the table of the scene itself
    std::vector<Row> rows;
    std::string scene;  // Lua, with FIELDS in the place of the fields
};

std::vector<FieldTable> field_tables() {
    // By topic: a scene with VALUE in the place of the topic's value.
    const std::map<std::string, std::string> scenes = {
        {"Materials", "return { solids = { cube():material(VALUE) } }"},
        {"Textures", "return { solids = { cube():material(matte{ color = VALUE }) } }"},
        {"Lights", "return { lights = { VALUE }, solids = { cube() } }"},
        {"Round parts", "return { solids = { VALUE } }"},
        {"Quadrics", "return { solids = { VALUE } }"}};
    std::vector<FieldTable> tables;
    std::string topic;
    for (const PagePart& part : scene_parts()) {
        if (part.level == 2) topic = part.heading;
        std::vector<Row> rows = rows_of(part.text);
        std::erase_if(rows, [](const Row& row) { return row.cell("field").empty(); });
        if (rows.empty()) continue;
        const std::string name = part.names.front();
        FieldTable table{name, rows, ""};
        if (part.level == 2)
            table = {"", rows, "return { FIELDS }"};
        else if (name == "frame")
            table.scene = "return { camera = frame{ FIELDS }, solids = { cube() } }";
        else if (topic == "Scene")
            table.scene = "return { " + name + " = { FIELDS }, solids = { cube() } }";
        else if (name == "sky" || name == "environment")
            table.scene = "return { background = " + name + "{ FIELDS }, solids = { cube() } }";
        else
            table.scene = std::regex_replace(scenes.at(topic), std::regex("VALUE"), name + "{ FIELDS }");
        tables.push_back(table);
    }
    return tables;
}

/// The fields that a table of this owner must have beside the field `name` to be accepted.
std::string fields_beside(const FieldTable& table, const std::string& name) {
    if (table.owner == "quadric") return name == "xy" ? "c = 0.5, xz = 1, " : "xy = 1, ";
    const std::map<std::string, std::string> values = {
        {"solids", "{ cube() }"}, {"position", "{0, 5, 0}"}, {"direction", "{1, -2, -1}"}, {"radius", "1"},
        {"file", "'room.exr'"},   {"u", "{1, 0, 0}"},        {"v", "{0, 0, 1}"},           {"tube", "0.5"}};
    std::string fields;
    for (const Row& row : table.rows)
        if (const std::string other = quoted(row.cell("field")); row.cell("default") == "required" && other != name)
            fields += other + " = " + values.at(other) + ", ";
    return fields;
}

std::string scene_with(const FieldTable& table, const std::string& fields) {
    return std::regex_replace(table.scene, std::regex("FIELDS"), fields);
}

// All of a scene except its solids' densities, as text to compare.
std::string summary(const Scene& s) {
    const auto text = [](Vec3 v) { return fmt::format("({} {} {}) ", v.x, v.y, v.z); };
    std::string all = fmt::format("{} {} {} {} {} ", s.width, s.height, s.spp.value_or(0), s.bounces, s.exposure) +
                      text(s.camera.eye) + text(s.camera.target) + text(s.camera.up) +
                      fmt::format("{} {} ", s.camera.fov, s.camera.orthographic) + text(s.camera.shift) +
                      text(s.ambient) + text(s.background.color) + text(s.background.horizon) +
                      text(s.background.zenith) + fmt::format("{} {} ", s.background.sky, s.caustics);
    if (s.framing) all += text(glm::normalize(s.framing->from)) + fmt::format("{} ", s.framing->fov);
    for (const Light& l : s.lights)
        all += fmt::format("{} ", int(l.kind)) + text(l.position) + text(l.direction) + text(l.u) + text(l.v) +
               text(l.color) + fmt::format("{} {} {} {} ", l.power, l.samples, l.radius, l.visible);
    for (const Material& m : s.materials)
        all += fmt::format("{} {} {} ", int(m.kind), m.roughness, m.ior) +
               fmt::format("{} {} ", int(m.color.kind), m.color.scale) + text(m.color.a) + text(m.color.b) +
               text(m.color.axis) + text(m.color.origin) + text(m.emission) +
               fmt::format("{} {} {} {} ", m.metallic, m.transmission, m.clearcoat, m.clearcoat_roughness) +
               fmt::format("{} {} {} ", m.color.turbulence, m.color.octaves, m.color.around) +
               fmt::format("{} {} {} ", m.color.rotate, m.color.blend, m.bump_height);
    for (const Solid& solid : s.solids)
        if (const auto* form = dynamic_cast<const FreeForm*>(solid.node().field().get())) {
            for (int k = 0; k < 3; ++k) all += text(form->base().A[k]);
            all += text(form->base().b) + text(form->base().center) + fmt::format("{} ", form->base().k);
        }
    return all;
}

// A valid value, as Lua, for the argument that the page calls `name`.
std::string argument(const std::string& function, const std::string& name) {
    if (name == "points" && function == "prism") return "{ {0, 0}, {1, 0}, {0, 1} }";
    static const std::map<std::string, std::string> values = {
        {"normal", "{0, 1, 0}"},
        {"lower", "{0, 0, 0}"},
        {"upper", "{1, 1, 1}"},
        {"density", "cube()"},
        {"axis", "{0, 1, 0}"},
        {"m", "matte{}"},
        {"text", "'lid'"},
        {"name", "'r'"},
        {"file", "'none.stl'"},
        {"quadric", "ellipsoid{}"},
        {"base", "ellipsoid{}"},
        {"perturbations", "{}"},
        {"points", "{ {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1} }"},
        {"low", "0"},
        {"options", "{}"}};
    const auto found = values.find(name);
    return found == values.end() ? "1" : found->second;
}

}  // namespace

TEST_CASE("docs/scenes.md has a part for every function, method and operator of the scene language") {
    const std::vector<PagePart> parts = scene_parts();
    for (const SceneFunction* function : scene_functions()) {
        INFO(function->name);
        CHECK(std::count_if(parts.begin(), parts.end(), [&](const PagePart& part) {
                  return part.level == 3 && is_heading_of(*function, part.heading);
              }) == 1);
    }
    CHECK(scene_functions().size() > 30);
}

TEST_CASE("docs/scenes.md names no function and no method that the program does not have") {
    std::set<std::string> methods;
    for (const SceneFunction* function : scene_functions())
        if (function->kind == SceneFunction::Kind::method) methods.insert(function->name);
    const std::string page = project_file("docs/scenes.md");
    const std::regex in_quotes("`[^`\n]+`"), call("(:?)\\b([a-z_][a-z_.]*)[({]");
    int calls = 0;
    const auto check = [&](const std::string& code) {
        for (std::sregex_iterator at(code.begin(), code.end(), call), end; at != end; ++at, ++calls) {
            const std::string name = (*at)[2];
            INFO(code);
            if ((*at)[1] == ":")
                CHECK(methods.count(name) == 1);
            else
                CHECK(error_of("local f = " + name + " return { solids = { cube() } }") == "no error");
        }
    };
    for (std::sregex_iterator at(page.begin(), page.end(), in_quotes), end; at != end; ++at) check(at->str());
    for (const PagePart& part : scene_parts())
        if (part.level == 3) check(part.heading);
    CHECK(calls > 40);
}

TEST_CASE("every piece of code in docs/scenes.md and in the README is a scene, or becomes one with a list of solids") {
    int blocks = 0;
    for (const char* file : {"docs/scenes.md", "README.md"})
        for (const std::string& code : lua_blocks(project_file(file))) {
            INFO(code);
            const bool whole = code.find("\nreturn {") != std::string::npos || code.rfind("return {", 0) == 0;
            CHECK(error_of(whole ? code : code + "\nreturn { solids = { cube() } }") == "no error");
            ++blocks;
        }
    CHECK(blocks > 35);
}

TEST_CASE("docs/scenes.md has the fields that the program knows, and no others") {
    const std::vector<FieldTable> tables = field_tables();
    for (const FieldTable& table : tables) {
        std::string on_page;
        for (const Row& row : table.rows) on_page += (on_page.empty() ? "" : ", ") + quoted(row.cell("field"));
        const std::string error = error_of(scene_with(table, "nonsense = 1"));
        INFO(table.owner << ": " << error);
        const std::string start = "expected one of the fields ", end = ", got 'nonsense'";
        REQUIRE(error.find(start) != std::string::npos);
        const std::size_t from = error.find(start) + start.size();
        std::vector<std::string> known, named;
        const auto split = [](std::string list) {
            std::set<std::string> names;
            for (std::size_t comma; (comma = list.find(", ")) != std::string::npos; list.erase(0, comma + 2))
                names.insert(list.substr(0, comma));
            names.insert(list);
            return names;
        };
        CHECK(split(on_page) == split(error.substr(from, error.find(end) - from)));
    }
    CHECK(tables.size() ==
          4 + 2 + 6 + 6 + 6 + 6);  // scene, round parts, quadrics, materials, textures, lights with the sky
}

TEST_CASE("docs/scenes.md says of every field what the program says that it takes") {
    for (const FieldTable& table : field_tables())
        for (const Row& row : table.rows) {
            const std::string name = quoted(row.cell("field"));
            // No field takes a function, so the error says what the field takes.
            const std::string error = error_of(scene_with(table, fields_beside(table, name) + name + " = print"));
            const std::string start = name + ": expected ", end = ", got a function";
            INFO(error);
            REQUIRE(error.find(start) != std::string::npos);
            REQUIRE(error.ends_with(end));
            const std::size_t from = error.find(start) + start.size();
            const std::string takes = error.substr(from, error.size() - end.size() - from);
            if (takes == "a colour, sky{…} or environment{…}" || takes == "a table of named fields or frame{…}")
                continue;
            CHECK(row.cell("takes").substr(0, takes.size()) == takes);
        }
}

TEST_CASE("docs/scenes.md has the defaults of the fields") {
    int defaults = 0;
    for (const FieldTable& table : field_tables())
        for (const Row& row : table.rows) {
            const std::string name = quoted(row.cell("field")), value = quoted(row.cell("default"));
            if (value.empty()) continue;  // required, or described in words
            const auto read = [&](const std::string& fields) {
                return summary(read_scene_text(scene_with(table, fields_beside(table, name) + fields), "s.lua", {}));
            };
            INFO(table.owner << "." << name << " = " << value);
            // A scene with neither ambient nor lights gets a default light, which `lights = {}` prevents.
            const std::string beside = name == "ambient" ? "lights = {}, " : "";
            CHECK(read(beside) == read(beside + name + " = " + value));
            ++defaults;
        }
    CHECK(defaults > 60);
}

TEST_CASE("docs/scenes.md has the limits of a scene") {
    const std::string page = project_file("docs/scenes.md");
    const SandboxLimits limits;
    CHECK(contains(page, fmt::format("{} MiB of memory, {} million steps and {} seconds", limits.memory >> 20,
                                     limits.work / 1'000'000, limits.seconds)));
    CHECK(contains(page, fmt::format("{}\nMiB of parts, {} MiB printed", limits.parts >> 20, limits.output >> 20)));
    CHECK(contains(page, fmt::format("at\nmost {},000,000 half-spaces", max_half_spaces / 1e6)));
}

TEST_CASE("docs/scenes.md has the arguments of every function, and what each takes") {
    int arguments = 0;
    for (const SceneFunction* function : scene_functions())
        for (const PagePart& part : scene_parts()) {
            if (part.level != 3 || !is_heading_of(*function, part.heading)) continue;
            std::vector<Row> rows = rows_of(part.text);
            std::erase_if(rows, [](const Row& row) { return row.cell("argument").empty(); });
            const std::string name = function->name;
            const bool method = function->kind == SceneFunction::Kind::method;
            const auto call = [&](std::size_t wrong, std::size_t more) {
                std::string words;
                for (std::size_t i = 0; i < rows.size() + more; ++i)
                    words += (i ? ", " : "") + (i == wrong        ? "print"
                                                : i < rows.size() ? argument(name, quoted(rows[i].cell("argument")))
                                                                  : "1");
                return error_of((method ? "local x = cube():" : "local x = ") + name + "(" + words +
                                ") return { solids = { cube() } }");
            };
            for (std::size_t i = 0; i < rows.size(); ++i, ++arguments) {
                const std::string takes = rows[i].cell("takes");
                INFO(part.heading);
                INFO(call(i, 0));
                CHECK(contains(call(i, 0), "expected " + takes + ", got a function"));
            }
            if (part.heading.find('(') == std::string::npos) continue;
            INFO(part.heading);
            // The model's file does not exist, so this error is about the file.
            CHECK(contains(call(rows.size(), 0), name == "model" ? "none.stl" : "no error"));
            CHECK(contains(call(rows.size() + 1, 1), fmt::format("expected at most {} arg", rows.size() + method)));
            // The part's heading lists the same arguments.
            std::string list;
            for (const Row& row : rows) list += (list.empty() ? "" : ", ") + quoted(row.cell("argument"));
            CHECK(part.heading.substr(part.heading.find('(')) == "(" + list + ")");
        }
    CHECK(arguments > 25);
}
