// `deburr export-pov SCENE -o FILE`: writes the scene for POV-Ray, for comparisons.
#include <fmt/format.h>

#include <memory>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/option_values.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/image/scene_pictures.hpp"
#include "raytracer/pov/pov_scene.hpp"
#include "raytracer/scene/illegal_densities.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/message.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

struct ExportPovOptions : Options {
    PovSurface surface;
    bool radiosity = false;
};

int run_export_pov(const ExportPovOptions& o) {
    if (o.scene.empty()) throw UsageError("export-pov: expected a scene file");
    if (o.outputs.empty()) throw UsageError("export-pov: expected an output file, -o FILE");
    for (const std::string& path : o.outputs)
        if (!path.ends_with(".pov"))
            throw UsageError(fmt::format("-o: expected a name that ends in .pov, got '{}'", path));
    check_outputs(o.outputs, {}, {o.scene});
    if (o.surface.sharp && (o.surface.max_gradient > 0 || o.surface.accuracy > 0 || o.surface.min_max))
        throw UsageError(
            "--sharp: expected neither --max-gradient, --accuracy nor --min-max, which are for isosurfaces");

    Scene scene = load_scene(o);
    load_pictures(scene);
    for (const std::string& path : o.outputs) check_writable(path);
    const PovScene pov = pov_scene(scene, picture_size(o, scene), o.surface, o.radiosity);
    if (!o.quiet) {
        for (const std::string& what : illegal_densities(scene)) message("warning: " + what);
        for (const std::string& what : pov.warnings) message(what);
    }
    for (const std::string& path : o.outputs) write_whole_file(path, pov.text);
    return 0;
}

}  // namespace

Command add_export_pov_command(CLI::App& program) {
    CLI::App* command = add_command(program, "export-pov", "write a scene for POV-Ray 3.7, to compare with");
    const auto options = std::make_shared<ExportPovOptions>();
    ExportPovOptions& o = *options;
    add_scene_options(*command, o);
    add_output_option(*command, o, ".pov");
    add_view_options(*command, o);
    command->add_flag("--sharp", o.surface.sharp, "sharp edges: CSG of planes and boxes, no isosurfaces");
    command->add_flag("--radiosity", o.radiosity,
                      "diffuse light goes from surface to surface, as in render; default: as much of it everywhere");
    command->add_flag(
        "--min-max", o.surface.min_max,
        "the profile with min and max, as a formula has it; default: by cases, in half of POV-Ray's time");
    command
        ->add_option_function<std::string>(
            "--max-gradient",
            [&o](const std::string& text) { o.surface.max_gradient = parse_positive("--max-gradient", text); },
            "of every isosurface; default: proved for each")
        ->type_name("G");
    command
        ->add_option_function<std::string>(
            "--accuracy", [&o](const std::string& text) { o.surface.accuracy = parse_positive("--accuracy", text); },
            "of every isosurface; default: 0.0001 of its least radius (POV-Ray's own is 0.001)")
        ->type_name("A");
    command->add_flag("-q,--quiet", o.quiet, "say nothing but errors");
    return {command, [options] { return run_export_pov(*options); }};
}

}  // namespace deburr
