// `deburr info SCENE`: what a scene contains, and whether its densities are legal.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/scene/illegal_densities.hpp"
#include "raytracer/scene/scene_descriptions.hpp"
#include "raytracer/scene/seam_warnings.hpp"
#include "raytracer/scene/solid_survey.hpp"
#include "raytracer/scene/vanished_parts.hpp"
#include "raytracer/scene/view_warnings.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions : Options {
    bool json = false;
};

const char* name_of(Light::Kind kind) {
    switch (kind) {
        case Light::Kind::point: return "point";
        case Light::Kind::directional: return "directional";
        case Light::Kind::area: return "area";
        case Light::Kind::sphere: return "sphere";
    }
    return "";
}

Json json_of(Vec3 v) {
    // JSON has no infinity, so an infinite side is null.
    Json j = Json::array();
    for (int k = 0; k < 3; ++k) j.push_back(std::isfinite(v[k]) ? Json(v[k] + 0.0) : Json(nullptr));  // turns −0 into 0
    return j;
}

// Boxes are larger than their solid by this fraction of their largest coordinate, or by this if all planes pass through
// the origin (bounds/polyhedron_box.cpp).
constexpr double box_slack = 1e-9;

// The box with each side rounded to the decimal place above its slack, so that a cube begins at 0 and not at -1e-09.
Json json_of(const Box& box) {
    if (box.empty()) return nullptr;
    double largest = 0;
    for (int k = 0; k < 3; ++k)
        for (const double side : {box.lo[k], box.hi[k]})
            if (std::isfinite(side)) largest = glm::max(largest, std::abs(side));
    if (largest == box_slack) largest = 1;
    const double places = std::floor(-std::log10(4 * box_slack * largest));
    const double unit = std::pow(10.0, std::abs(places));  // exact, unlike its inverse
    const auto rounded = [&](double x) {
        if (!std::isfinite(x)) return x;
        const double r = places > 0 ? std::round(x * unit) / unit : std::round(x / unit) * unit;
        return std::isfinite(r) ? r + 0.0 : x;  // turns −0 into 0
    };
    Box shown = box;
    for (int k = 0; k < 3; ++k) {
        shown.lo[k] = rounded(box.lo[k]);
        shown.hi[k] = rounded(box.hi[k]);
    }
    return {{"lo", json_of(shown.lo)}, {"hi", json_of(shown.hi)}};
}

// Work limit for finding parts that vanish: ten times that of `render`.
constexpr std::int64_t nodes_to_look_at = 200'000'000;

// All information about the scene; the text is made from it, too.
Json describe(const Scene& scene, Size size) {
    Json j;
    j["scene"] = scene.file;
    j["image"] = {
        {"width", size.width}, {"height", size.height}, {"spp", scene.spp ? Json(*scene.spp) : Json(nullptr)}};
    j["camera"] = {{"eye", json_of(scene.camera.eye)},
                   {"target", json_of(scene.camera.target)},
                   {"up", json_of(scene.camera.up)},
                   {"fov", scene.camera.fov}};
    j["parameters"] = scene.parameters;
    Box all;
    double half_spaces = 0, quadrics = 0, round_parts = 0, triangles = 0;
    SolidSurvey survey;
    j["solids"] = Json::array();
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        const SolidFacts own = survey.at(scene.solids[i]);
        all = own.box.empty() ? all : hull(all, own.box);
        half_spaces += own.half_spaces;
        quadrics += own.quadrics;
        round_parts += own.round_parts;
        triangles += own.triangles;
        j["solids"].push_back({{"id", i + 1},
                               {"name", i < scene.names.size() ? scene.names[i] : ""},
                               {"half_spaces", own.half_spaces},
                               {"quadrics", own.quadrics},
                               {"round_parts", own.round_parts},
                               {"bounds", json_of(own.box)}});
        if (own.triangles > 0)
            j["solids"].back()["models"] = {{"triangles", own.triangles},
                                            {"faces", own.faces},
                                            {"sharp_volume", own.model_volume},
                                            {"radius", own.model_radius}};
    }
    j["half_spaces"] = half_spaces;
    j["quadrics"] = quadrics;
    j["round_parts"] = round_parts;
    j["triangles"] = triangles;
    j["bounds"] = json_of(all);
    j["materials"] = Json::array();
    for (const Material& material : scene.materials) j["materials"].push_back(name_of(material.kind));
    j["lights"] = Json::array();
    for (const Light& light : scene.lights)
        j["lights"].push_back({{"kind", name_of(light.kind)}, {"power", light.power}});
    j["illegal_densities"] = illegal_densities(scene);
    const VanishedParts vanished = vanished_parts(scene, nodes_to_look_at);
    j["warnings"] = Json::array();
    for (const auto& lines : {vanished.rounded_away, vanished.empty, seam_warnings(scene),
                              view_warnings(scene, double(size.width) / size.height)})
        for (const std::string& line : lines) j["warnings"].push_back(line);
    return j;
}

// The coordinates of vectors as text; those that are rounding errors compared with the largest one become 0.
std::vector<std::string> texts_of(const std::vector<Json>& vectors) {
    constexpr double nothing = 1e-9;
    double largest = 0;
    for (const Json& vector : vectors)
        for (const Json& x : vector)
            if (!x.is_null()) largest = std::max(largest, std::abs(x.get<double>()));
    std::vector<std::string> texts;
    for (const Json& vector : vectors) {
        std::string& text = texts.emplace_back();
        for (const Json& x : vector) {
            const double value = x.is_null() ? infinity : x.get<double>();
            text += fmt::format("{}{:.6g}", text.empty() ? "" : " ", std::abs(value) <= nothing * largest ? 0 : value);
        }
    }
    return texts;
}

// "lo .. hi", where an infinite side is -inf or inf.
std::string text_of_box(const Json& box) {
    if (box.is_null()) return "empty";
    std::string text;
    for (std::size_t k = 0; k < 3; ++k) {
        const Json &lo = box["lo"][k], &hi = box["hi"][k];
        text +=
            fmt::format("{}[{}, {}]", k ? " x " : "", lo.is_null() ? "-inf" : fmt::format("{:.6g}", lo.get<double>()),
                        hi.is_null() ? "inf" : fmt::format("{:.6g}", hi.get<double>()));
    }
    return text;
}

// A count such as "12 half-spaces "; "" for 0.
std::string some(const Json& count, const char* of_what) {
    return count > 0 ? fmt::format("{:.0f} {} ", count.get<double>(), of_what) : "";
}

// A text such as "12 triangles on 6 faces, volume 8 when sharp, rounded by 0.5, "; "" for a solid without models.
std::string text_of_models(const Json& solid) {
    if (!solid.contains("models")) return "";
    const Json& m = solid["models"];
    const double radius = m["radius"].get<double>();
    return fmt::format("{:.0f} triangles on {:.0f} faces, volume {:.6g} when sharp, {}", m["triangles"].get<double>(),
                       m["faces"].get<double>(), m["sharp_volume"].get<double>(),
                       radius > 0 ? fmt::format("rounded by {:g}, ", radius) : "");
}

void print(const Json& j) {
    const auto row = [](const std::string& name, const std::string& value) {
        fmt::print("{:<14}{}\n", name, printable(value));
    };
    row("scene", j["scene"].get<std::string>());
    row("image",
        fmt::format("{}x{}, {} samples per pixel", j["image"]["width"].get<int>(), j["image"]["height"].get<int>(),
                    j["image"]["spp"].is_null() ? "as many as it takes" : j["image"]["spp"].dump()));
    const Json& camera = j["camera"];
    const std::vector<std::string> places = texts_of({camera["eye"], camera["target"]});
    row("camera", fmt::format("eye {}; target {}; up {}; fov {:g}", places[0], places[1], texts_of({camera["up"]})[0],
                              camera["fov"].get<double>()));
    for (const auto& [name, value] : j["parameters"].items())
        row("parameter", fmt::format("{} = {}", name, value.get<std::string>()));
    row("bounds", text_of_box(j["bounds"]));
    if (j["half_spaces"] > 0 || j["triangles"] == 0)
        row("half-spaces", fmt::format("{:.0f}", j["half_spaces"].get<double>()));
    if (j["triangles"] > 0) row("triangles", fmt::format("{:.0f}", j["triangles"].get<double>()));
    if (j["quadrics"] > 0) row("quadrics", fmt::format("{:.0f}", j["quadrics"].get<double>()));
    if (j["round_parts"] > 0) row("round parts", fmt::format("{:.0f}", j["round_parts"].get<double>()));
    row("solids", fmt::format("{}", j["solids"].size()));
    for (const Json& solid : j["solids"]) {
        const auto name = solid["name"].get<std::string>();
        row(fmt::format("  {}", solid["id"].get<std::size_t>()),
            fmt::format("{}{}{}{}{}in {}", name.empty() ? "" : name + ": ", some(solid["half_spaces"], "half-spaces"),
                        some(solid["round_parts"], "round parts"), some(solid["quadrics"], "quadrics"),
                        text_of_models(solid), text_of_box(solid["bounds"])));
    }
    row("materials", fmt::format("{}", j["materials"].size()));
    for (std::size_t i = 0; i < j["materials"].size(); ++i)
        row(fmt::format("  {}", i), j["materials"][i].get<std::string>());
    row("lights", fmt::format("{}", j["lights"].size()));
    for (const Json& light : j["lights"])
        row("", fmt::format("{}, power {:g}", light["kind"].get<std::string>(), light["power"].get<double>()));
    if (!j.contains("illegal_densities")) return;
    const Json& illegal = j["illegal_densities"];
    row("densities", illegal.empty() ? "legal" : fmt::format("{} illegal", illegal.size()));
    for (const Json& what : illegal) row("", what.get<std::string>());
    for (const Json& what : j["warnings"]) row("warning", what.get<std::string>());
}

int run_info(const InfoOptions& o) {
    const Scene scene = load_scene(o);
    const Json description = describe(scene, picture_size(o, scene));
    if (o.json)  // in ASCII, so that nothing must be escaped for terminals
        fmt::print("{}\n", description.dump(2, ' ', true, Json::error_handler_t::replace));
    else
        print(description);
    return 0;
}

}  // namespace

Command add_info_command(CLI::App& program) {
    CLI::App* command = add_command(program, "info", "say what is in a scene, and whether its densities are legal");
    const auto options = std::make_shared<InfoOptions>();
    add_scene_options(*command, *options);
    add_view_options(*command, *options);
    command->add_flag("--json", options->json, "as JSON");
    return {command, [options] { return run_info(*options); }};
}

}  // namespace deburr
