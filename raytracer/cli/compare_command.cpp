// `deburr compare SCENE` or `deburr compare A B`: the difference between implicit and mesh rendering, or between two
// files.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/farm_options.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/image/image_difference.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/image/scene_pictures.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/printable.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

struct CompareOptions : Options {
    std::string second, via, tolerance, json;
    std::string max_missed, max_distance, max_rmse;
};

Film trace(const Scene& scene, const RayTracer& tracer, Size size, const Window& window, int spp, std::uint64_t seed) {
    const Integrator integrator(scene, tracer, {size.width, size.height, spp, seed, false});
    return render(Film(size.width, size.height, window, compared_layers()),
                  [&](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
                      integrator.block(block, pixels, layers, counters);
                  })
        .film;
}

Json json_of(const DifferenceFigures& f) { return {{"mean", f.mean}, {"p99", f.p99}, {"max", f.max}}; }

Json json_of(const PictureDifference& d) {
    const double missed =
        d.on_object ? 100.0 * double(d.only_first + d.only_second + d.other_solid) / double(d.on_object) : 0;
    Json j = {{"pixels", d.pixels},           {"pixels_on_object", d.on_object}, {"only_first", d.only_first},
              {"only_second", d.only_second}, {"other_solid", d.other_solid},    {"missed_percent", missed}};
    if (d.distance) {
        j["distance_unit"] = d.in_radii ? "radius" : "scene";
        j["distance"] = json_of(*d.distance);
    }
    if (d.normal_degrees) j["normal_degrees"] = json_of(*d.normal_degrees);
    j["rmse"] = d.rmse;
    j["psnr"] = std::isfinite(d.psnr) ? Json(d.psnr) : Json(nullptr);
    j["perceptual_fails"] = d.perceptual_fails;
    return j;
}

std::vector<double> radii(const SceneMesh& mesh) {
    std::vector<double> all;
    for (const SolidTree& tree : mesh.trees) all.push_back(tree.min_radius());
    return all;
}

// The two pictures, and what is reported about them.
struct Compared {
    Film a, b;
    std::vector<double> units;  // unit of distances for each solid; empty: the scene's unit
    Json j;
};

Compared read_two(const CompareOptions& o) {
    Compared c;
    c.a = read_picture(o.scene);
    c.b = read_picture(o.second);
    if (c.a.window != c.b.window)
        throw UsageError(fmt::format("compare: expected pictures of one size, got {}x{} and {}x{}", c.a.window.width,
                                     c.a.window.height, c.b.window.width, c.b.window.height));
    c.j["first"] = o.scene;
    c.j["second"] = o.second;
    return c;
}

Compared render_both(const CompareOptions& o) {
    const MeshSettings settings = picture_mesh_settings(o.via, o.tolerance);
    Scene scene = load_scene(o);
    load_pictures(scene);
    const Size size = picture_size(o, scene);
    const Window window = picture_window(o, scene, 2 * Film::bytes_per_pixel(compared_layers()));
    const int spp = o.spp.value_or(1);
    const SceneMesh mesh = mesh_scene(scene, settings);
    Compared c;
    c.units = radii(mesh);
    c.a = trace(scene, ImplicitTracer(scene.solids), size, window, spp, o.seed);
    c.b = trace(scene, MeshTracer(mesh.mesh, mesh.near), size, window, spp, o.seed);
    c.j["scene"] = scene.file;
    c.j["first"] = "implicit";
    c.j["second"] = mesh.method_names();
    c.j["triangles"] = mesh.mesh.triangles.size();
    return c;
}

void print_difference(const Json& j) {
    for (const auto& [name, value] : j.items()) {
        if (value.is_object())
            fmt::print("{:<20}mean {:.6g}, 99 % {:.6g}, max {:.6g}\n", name, value["mean"].get<double>(),
                       value["p99"].get<double>(), value["max"].get<double>());
        else if (value.is_number_float())
            fmt::print("{:<20}{:.6g}\n", name, value.get<double>());
        else if (value.is_string())
            fmt::print("{:<20}{}\n", name, printable(value.get<std::string>()));
        else if (name == "within_limits" && value.is_null())
            fmt::print("{:<20}no limit was given\n", name);
        else
            fmt::print("{:<20}{}\n", name, value.is_null() ? "infinite" : value.dump());
    }
}

int run_compare(const CompareOptions& o) {
    if (o.scene.empty()) throw UsageError("compare: expected a scene file, or two pictures");
    check_image_names("-o", o.outputs);
    check_outputs(o.outputs, {o.json}, {o.scene, o.second});
    const auto limit_of = [](const char* name, const std::string& text) {
        return text.empty() ? infinity : parse_limit(name, text);
    };
    const double max_missed = limit_of("--max-missed", o.max_missed);
    const double max_distance = limit_of("--max-distance", o.max_distance);
    const double max_rmse = limit_of("--max-rmse", o.max_rmse);
    const int threads = o.threads.value_or(default_threads());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));

    Compared c = o.second.empty() ? render_both(o) : read_two(o);
    const PictureDifference d = difference(c.a, c.b, c.units);
    c.j.update(json_of(d));
    const double missed = c.j["missed_percent"].get<double>();
    const double distance = d.distance ? d.distance->p99 : 0;
    const bool within = missed <= max_missed && distance <= max_distance && d.rmse <= max_rmse;
    const bool limited = max_missed < infinity || max_distance < infinity || max_rmse < infinity;
    c.j["within_limits"] = limited ? Json(within) : Json(nullptr);
    for (const std::string& path : o.outputs) write_difference(path, c.a, c.b);
    if (!o.json.empty()) write_whole_file(o.json, c.j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    if (!o.quiet) print_difference(c.j);
    return within ? 0 : 1;
}

}  // namespace

Command add_compare_command(CLI::App& program) {
    CLI::App* command = add_command(
        program, "compare", "say how far a scene's implicit picture and its mesh's, or two pictures, are apart");
    const auto options = std::make_shared<CompareOptions>();
    add_scene_options(*command, *options);
    command->add_option("SECOND", options->second, "a second picture; the first takes the scene's place")
        ->type_name("");
    add_output_option(*command, *options, known_extensions());
    add_picture_options(*command, *options, "1");
    command
        ->add_option("--via", options->via,
                     mesh_method_names() + "; default: triage, and octree for solids with free forms")
        ->type_name("NAME");
    command
        ->add_option("--tolerance", options->tolerance,
                     "the mesh's tolerance, as for mesh; default: 0.03 of each solid's least radius")
        ->type_name("D");
    command->add_option("--json", options->json, "write the figures as JSON")->type_name("FILE");
    command
        ->add_option("--max-missed", options->max_missed,
                     "exit code 1 if more pixels, in percent of the object's, see another solid or none")
        ->type_name("P");
    command->add_option("--max-distance", options->max_distance, "exit code 1 if not 99 % of the hits are nearer")
        ->type_name("D");
    command->add_option("--max-rmse", options->max_rmse, "exit code 1 if colours differ more")->type_name("E");
    add_run_options(*command, *options);
    return {command, [options] { return run_compare(*options); }};
}

}  // namespace deburr
