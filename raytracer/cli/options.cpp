#include "raytracer/cli/options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <unordered_set>

#include "bounds/canonical_solids.hpp"
#include "bounds/solid_tree.hpp"
#include "raytracer/model/model_format.hpp"
#include "raytracer/scene/frame_camera.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/message.hpp"

namespace deburr {
namespace {

constexpr int max_threads = 1024;

// Adds an option whose text is passed to a function, since CLI11's own conversions do not check these ranges.
template <class Function>
void add(CLI::App& command, const char* name, const char* type, const std::string& help, Function take) {
    command.add_option_function<std::string>(name, std::function<void(const std::string&)>(take), help)
        ->type_name(type);
}

}  // namespace

void add_scene_options(CLI::App& command, Options& o) {
    command
        .add_option("SCENE", o.scene,
                    "the scene, a Lua file, or a model: STL, OBJ, PLY, OFF, 3MF, GLB, or .scad through openscad")
        ->type_name("");
    command
        .add_option_function<std::vector<std::string>>(
            "-D",
            [&o](const std::vector<std::string>& all) {
                for (const std::string& text : all) parse_define("-D", text, o.defines);
            },
            "set a parameter of the scene; repeatable")
        ->type_name("name=value")
        ->allow_extra_args(false);
    command
        .add_option("--model-path", o.model_folders, "where a scene's model() looks after its own folder; repeatable")
        ->type_name("DIR")
        ->allow_extra_args(false);
    const auto add_of_model = [&](const char* name, const char* type, const std::string& help, auto take) {
        add(command, name, type, "of a model: " + help, [&o, take](const std::string& text) {
            o.is_model_option_given = true;
            take(text);
        });
    };
    add_of_model("--round", "R", "round all edges by this radius, in the file's units; default: 0",
                 [&o](const std::string& text) { o.model.round = parse_limit("--round", text); });
    command
        .add_option_function<std::vector<std::string>>(
            "--keep-sharp",
            [&o](const std::vector<std::string>& all) {
                o.is_model_option_given = true;
                for (const std::string& text : all) parse_keep_sharp("--keep-sharp", text, o.model.keep);
            },
            "of a model: do not round its convex or its concave edges, or what is below or above a height or in a box; "
            "repeatable")
        ->type_name("convex|concave|below=H|above=H|box=X,Y,Z,X,Y,Z")
        ->allow_extra_args(false);
    add_of_model("--fade", "W", "the width over which --keep-sharp's rounding fades; default: three radii",
                 [&o](const std::string& text) { o.model.keep.fade = parse_positive("--fade", text); });
    if (command.get_name() != "mesh")  // `mesh` has its own --up, which is the files' axis, too
        add_of_model("--up", "y|z", "the axis that is up; default: z, of GLB y",
                     [&o](const std::string& text) { o.model.z_up = parse_axis("--up", text) == 'z'; });
    add_of_model("--color", "R,G,B", "its colour, linear, from 0 to 1",
                 [&o](const std::string& text) { o.model.color = parse_color("--color", text); });
    add_of_model(
        "--material", "NAME", "matte, plastic, metal, mirror or glass; default: plastic",
        [&o](const std::string& text) { o.model.material = parse_word("--material", text, model_materials()); });
}

void add_output_option(CLI::App& command, Options& o, const std::string& formats, const std::string& more) {
    command.add_option("-o,--output", o.outputs, "write this file (" + formats + ")" + more + "; repeatable")
        ->type_name("FILE")
        ->allow_extra_args(false);
}

void add_view_options(CLI::App& command, Options& o) {
    add(command, "--size", "WxH", "size of the picture; default: what the scene says",
        [&o](const std::string& text) { o.size = parse_size("--size", text); });
    command.add_flag("--frame", o.frame,
                     "move the camera, without turning it, to where the bounded solids fill the picture");
    add(command, "--from", "X,Y,Z", "the same with the camera in this direction from the solids",
        [&o](const std::string& text) { o.from = parse_direction("--from", text); });
}

void add_picture_options(CLI::App& command, Options& o, const std::string& default_spp) {
    add_view_options(command, o);
    add(command, "--spp", "N", "samples per pixel, 1: one ray through its centre; default: " + default_spp,
        [&o](const std::string& text) { o.spp = int(parse_whole("--spp", text, 1, max_samples)); });
    add(command, "--crop", "WxH+X+Y", "only this part of the picture",
        [&o](const std::string& text) { o.crop = parse_crop("--crop", text); });
    add(command, "--seed", "N", "seed of all random numbers; default: 0",
        [&o](const std::string& text) { o.seed = parse_seed("--seed", text); });
    add(command, "--aov", "LIST",
        "further layers of an EXR: some of P,N,Z,albedo,normal,id,cost,crypto (Cryptomatte, by solid)",
        [&o](const std::string& text) { o.layers = parse_layers("--aov", text); });
    command.add_flag("--float", o.float_color, "32 bits for the colour of an EXR, not 16");
    add(command, "--criterion", "exact|lobb",
        "the test that a ray's segment holds one root at most: exact, or the printed one of Lobb's paper; default: "
        "exact",
        [&o](const std::string& text) { o.criterion = parse_criterion("--criterion", text); });
}

void add_run_options(CLI::App& command, Options& o) {
    add(command, "--threads", "N",
        "number of threads; default: as many as there are processors, or the job or control group may use",
        [&o](const std::string& text) { o.threads = int(parse_whole("--threads", text, 1, max_threads)); });
    command.add_flag("-q,--quiet", o.quiet, "say nothing but errors");
    command.add_flag("-v,--verbose", o.verbose, "say what is done");
}

void add_statistics_options(CLI::App& command, Options& o) {
    command.add_flag("--stats", o.stats, "print what the run did, and in what time");
    command.add_option("--stats-json", o.stats_json, "write the same as JSON")->type_name("FILE");
}

namespace {

// Whether a number, and products of a few hundred like it, neither overflow nor vanish.
bool is_ordinary(double x) { return std::abs(x) < 1e20; }

bool is_ordinary(const Affine& map) {
    const Mat3 inverse = glm::inverse(map.linear);
    bool fine = true;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            fine &= is_ordinary(map.linear[i][k]) && is_ordinary(inverse[i][k]) && is_ordinary(map.shift[i]);
    return fine;
}

// Errors in larger scenes are reported when their solids are flattened.
constexpr std::int64_t max_nodes_checked = 20'000'000;

// Finds errors that only show when all transforms of a placement are composed. A leaf that is ordinary after one
// ordinary transform is so after any other.
void check_placements(const Scene& scene) {
    std::unordered_set<const SolidNode*> ordinary;
    const auto check = [&](const Solid& leaf, const Affine& map) {
        const bool fine = is_ordinary(map);
        if (fine && ordinary.count(&leaf.node())) return;
        const SolidNode& node = leaf.node();
        bool all = fine;
        if (node.kind == SolidNode::Kind::rounded)
            for (const HalfSpace& h : flat_half_spaces(node.density(), node.radius(), map))
                all &= is_ordinary(h.offset) && is_ordinary(h.radius) && std::isfinite(glm::length(h.normal));
        if (!all || node.field()) flatten(leaf.transformed(map));  // throws if the transform leaves no planes
        if (all) ordinary.insert(&node);
    };
    try {
        std::int64_t nodes_left = max_nodes_checked;
        for_each_leaf(
            scene.solids, [&](const SolidNode&) { return nodes_left-- > 0; }, check);
    } catch (const SingularPlacement& error) {
        const std::string where = scene.place(error.line);
        throw SceneError(fmt::format("{}: {}", where, error.what()));
    }
}

}  // namespace

Scene load_scene(const Options& o) {
    if (o.scene.empty()) throw UsageError("expected a scene file");
    const bool is_model = is_model_path(o.scene);
    if (is_model && !o.defines.empty())
        throw UsageError(fmt::format("-D {}: expected a scene with parameters, got a model", o.defines.begin()->first));
    if (!is_model && o.is_model_option_given)
        throw UsageError(
            fmt::format("{}: expected a model file with --round, --keep-sharp, --fade, --up, --color or --material, "
                        "got a scene, which says these itself",
                        o.scene));
    if (o.model.keep.fade && !o.model.keep.any())
        throw UsageError("--fade: expected --keep-sharp with it, beside which the rounding fades");
    ModelSettings model = o.model;
    model.ground = !o.model_only;
    Scene scene = is_model ? model_scene(o.scene, model) : read_scene(o.scene, o.defines, {}, o.model_folders);
    for (const std::string& note : scene.notes)
        if (!o.quiet) message(note);
    check_placements(scene);
    if ((o.frame || o.from) && !scene.framing)
        scene.framing = Framing{scene.camera.eye - scene.camera.target, scene.camera.fov};
    if (o.from) scene.framing->from = *o.from;
    const Size size = picture_size(o, scene);
    frame_camera(scene, double(size.width) / size.height);
    return scene;
}

Size picture_size(const Options& o, const Scene& scene) {
    if (o.size) return *o.size;
    return {scene.width, scene.height};
}

Window picture_window(const Options& o, const Scene& scene, double bytes_per_pixel) {
    const Size size = picture_size(o, scene);
    const Window window = o.crop.value_or(Window{0, 0, size.width, size.height});
    check_crop("--crop", window, size);
    check_pixels(o.crop ? "--crop" : o.size ? "--size" : scene.file + ": image", window);
    // Fails now rather than being killed by the system in the middle of the work.
    const double needed = double(window.width) * window.height * bytes_per_pixel;
    const double there = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (needed > there)
        throw WorkError(fmt::format("{} of {}x{} needs {:.1f} GiB of memory, this machine has {:.1f}",
                                    o.crop ? "a crop" : "a picture", window.width, window.height, needed / 0x1p30,
                                    there / 0x1p30));
    return window;
}

}  // namespace deburr
