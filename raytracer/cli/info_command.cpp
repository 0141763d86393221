// deburr info SCENE: what is in a scene, and whether its densities are legal.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "bounds/bounding_box.hpp"
#include "bounds/canonical_solids.hpp"
#include "bounds/free_form.hpp"
#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/scene/illegal_densities.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions : Options {
    bool json = false;
};

const char* name_of(Material::Kind kind) {
    switch (kind) {
        case Material::Kind::matte: return "matte";
        case Material::Kind::plastic: return "plastic";
        case Material::Kind::metal: return "metal";
        case Material::Kind::mirror: return "mirror";
        case Material::Kind::glass: return "glass";
        case Material::Kind::pbr: return "pbr";
    }
    return "";
}

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
    // JSON has no infinity: a side that lies there is null.
    Json j = Json::array();
    for (int k = 0; k < 3; ++k) j.push_back(std::isfinite(v[k]) ? Json(v[k]) : Json(nullptr));
    return j;
}

// A box that holds a solid for certain is a little too large: by this share of its largest coordinate, or by this where
// all of its planes go through the origin (bounds/polyhedron_box.cpp).
constexpr double box_slack = 1e-9;

// The box with each side rounded to the decimal place above its slack: a cube begins at 0, not at -1e-09.
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
        return std::isfinite(r) ? r + 0.0 : x;  // -0 becomes 0
    };
    Box shown = box;
    for (int k = 0; k < 3; ++k) {
        shown.lo[k] = rounded(box.lo[k]);
        shown.hi[k] = rounded(box.hi[k]);
    }
    return {{"lo", json_of(shown.lo)}, {"hi", json_of(shown.hi)}};
}

// What a solid is made of.
struct Parts {
    double half_spaces = 0, quadrics = 0;
};

Parts parts_of(const SolidTree& tree) {
    Parts parts;
    for (const SolidLeaf& leaf : tree.leaves) {
        const auto* form = dynamic_cast<const FreeForm*>(leaf.field.get());
        if (form) parts.quadrics += 1.0 + double(form->perturbations().size());
        parts.half_spaces += double(leaf.density.half_spaces.size());
    }
    return parts;
}

struct SolidFacts {
    Box box;
    Parts parts;
};

// What solids are made of, and where. A solid that is too large to be laid out is a union that is looked at by its
// operands, each canonical one once; its box is the hull of theirs.
class Looking {
public:
    SolidFacts at(const Solid& solid) {
        if (solid.node().leaves <= max_half_spaces) {
            const SolidTree tree = flatten(solid);
            return {bounding_box(tree), parts_of(tree)};
        }
        const CanonicalPlacement placement = canonical_.of(solid);
        return placed(placement.map, of_canonical(placement.canonical));
    }

private:
    static SolidFacts placed(const Affine& map, const SolidFacts& facts) {
        if (facts.box.empty()) return facts;
        return {facts.box.finite() ? image(map, facts.box) : Box::everything(), facts.parts};
    }

    // With a stack of its own, for unions may be long chains.
    const SolidFacts& of_canonical(int root) {
        std::vector<int> open{root};
        while (!open.empty()) {
            const int canonical = open.back();
            const Solid solid = canonical_.solid(canonical);
            if (known_.count(canonical)) {
                open.pop_back();
            } else if (solid.node().kind != SolidNode::Kind::unite) {
                known_[canonical] = at(solid);
            } else {
                SolidFacts all;
                const std::size_t before = open.size();
                for (const Solid& child : solid.node().children()) {
                    const CanonicalPlacement part = canonical_.of(child);
                    const auto at = known_.find(part.canonical);
                    if (at == known_.end()) {
                        open.push_back(part.canonical);
                        continue;
                    }
                    const SolidFacts facts = placed(part.map, at->second);
                    if (!facts.box.empty()) all.box = hull(all.box, facts.box);
                    all.parts.half_spaces += facts.parts.half_spaces;
                    all.parts.quadrics += facts.parts.quadrics;
                }
                if (open.size() == before) known_[canonical] = all;
            }
        }
        return known_.at(root);
    }

    CanonicalSolids canonical_;
    std::unordered_map<int, SolidFacts> known_;
};

// All that info has to say; the text is made from it too.
Json describe(const Scene& scene, Size size) {
    Json j;
    j["scene"] = scene.file;
    j["image"] = {{"width", size.width}, {"height", size.height}, {"spp", scene.spp}};
    j["camera"] = {{"eye", json_of(scene.camera.eye)},
                   {"target", json_of(scene.camera.target)},
                   {"up", json_of(scene.camera.up)},
                   {"fov", scene.camera.fov}};
    j["parameters"] = scene.parameters;
    Box all;
    Parts parts;
    Looking looking;
    j["solids"] = Json::array();
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        const auto [box, own] = looking.at(scene.solids[i]);
        all = box.empty() ? all : hull(all, box);
        parts = {parts.half_spaces + own.half_spaces, parts.quadrics + own.quadrics};
        j["solids"].push_back({{"id", i + 1},
                               {"name", i < scene.names.size() ? scene.names[i] : ""},
                               {"half_spaces", own.half_spaces},
                               {"quadrics", own.quadrics},
                               {"bounds", json_of(box)}});
    }
    j["half_spaces"] = parts.half_spaces;
    j["quadrics"] = parts.quadrics;
    j["bounds"] = json_of(all);
    j["materials"] = Json::array();
    for (const Material& material : scene.materials) j["materials"].push_back(name_of(material.kind));
    j["lights"] = Json::array();
    for (const Light& light : scene.lights)
        j["lights"].push_back({{"kind", name_of(light.kind)}, {"power", light.power}});
    j["illegal_densities"] = illegal_densities(scene);
    return j;
}

std::string text_of(const Json& vector) {
    std::string text;
    for (const Json& x : vector) {
        text += text.empty() ? "" : " ";
        text += x.is_null() ? "inf" : fmt::format("{:.6g}", x.get<double>());
    }
    return text;
}

// lo .. hi, where a side at infinity has the sign of its end.
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

// As in "12 half-spaces "; nothing of none.
std::string some(const Json& count, const char* of_what) {
    return count > 0 ? fmt::format("{:.0f} {} ", count.get<double>(), of_what) : "";
}

void print(const Json& j) {
    const auto row = [](const std::string& name, const std::string& value) {
        fmt::print("{:<14}{}\n", name, printable(value));
    };
    row("scene", j["scene"].get<std::string>());
    row("image", fmt::format("{}x{}, {} samples per pixel", j["image"]["width"].get<int>(),
                             j["image"]["height"].get<int>(), j["image"]["spp"].get<int>()));
    const Json& camera = j["camera"];
    row("camera", fmt::format("eye {}; target {}; up {}; fov {:g}", text_of(camera["eye"]), text_of(camera["target"]),
                              text_of(camera["up"]), camera["fov"].get<double>()));
    for (const auto& [name, value] : j["parameters"].items())
        row("parameter", fmt::format("{} = {}", name, value.get<std::string>()));
    row("bounds", text_of_box(j["bounds"]));
    row("half-spaces", fmt::format("{:.0f}", j["half_spaces"].get<double>()));
    if (j["quadrics"] > 0) row("quadrics", fmt::format("{:.0f}", j["quadrics"].get<double>()));
    row("solids", fmt::format("{}", j["solids"].size()));
    for (const Json& solid : j["solids"]) {
        const auto name = solid["name"].get<std::string>();
        row(fmt::format("  {}", solid["id"].get<std::size_t>()),
            fmt::format("{}{}{}in {}", name.empty() ? "" : name + ": ", some(solid["half_spaces"], "half-spaces"),
                        some(solid["quadrics"], "quadrics"), text_of_box(solid["bounds"])));
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
}

int run_info(const InfoOptions& o) {
    const Scene scene = load_scene(o);
    const Json description = describe(scene, picture_size(o, scene));
    if (o.json)
        fmt::print("{}\n", description.dump(2, ' ', true, Json::error_handler_t::replace));  // ASCII: nothing to escape
    else
        print(description);
    return 0;
}

}  // namespace

Command add_info_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("info", "say what is in a scene, and whether its densities are legal");
    const auto options = std::make_shared<InfoOptions>();
    add_scene_options(*command, *options);
    command->add_flag("--json", options->json, "as JSON");
    return {command, [options] { return run_info(*options); }};
}

}  // namespace deburr
