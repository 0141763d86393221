// deburr mesh SCENE -o FILE …: the solids as a closed mesh.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "polygonizer/export.hpp"
#include "polygonizer/metrics.hpp"
#include "raytracer/commands.hpp"
#include "raytracer/errors.hpp"
#include "raytracer/options.hpp"
#include "raytracer/scene_mesh.hpp"
#include "raytracer/statistics.hpp"
#include "raytracer/whole_file.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

struct MeshCommandOptions : Options {
    std::string method = "triage", tolerance, grid;
};

MeshSettings settings(const MeshCommandOptions& o) {
    MeshSettings s;
    s.method = parse_mesh_method("--method", o.method);
    if (!o.tolerance.empty()) s.tolerance = parse_tolerance(o.tolerance);
    if (!o.grid.empty()) s.grid = parse_positive("--grid", o.grid);
    if (!o.tolerance.empty() && s.method != MeshMethod::triage)
        throw UsageError("--tolerance: expected --method triage, got '" + o.method + "'");
    if (!o.grid.empty() && s.method != MeshMethod::marching_cubes)
        throw UsageError("--grid: expected --method marching-cubes, got '" + o.method + "'");
    return s;
}

Json json_of(const Spread& s) { return {{"mean", s.mean}, {"max", s.max}}; }

Json json_of(const MeshMetrics& m) {
    const Topology& t = m.topology;
    return {{"vertices", t.vertices},
            {"edges", t.edges},
            {"triangles", t.triangles},
            {"polygons", m.polygons},
            {"closed", t.closed()},
            {"manifold", t.manifold()},
            {"open_edges", t.open_edges},
            {"nonmanifold_edges", t.nonmanifold_edges},
            {"nonmanifold_vertices", t.nonmanifold_vertices},
            {"shells", t.shells},
            {"euler", t.euler},
            {"area", m.area},
            {"volume", m.volume},
            {"vertex_distance_max", m.vertex_distance},
            {"triangle_distance_first_order", json_of(m.first_order)},
            {"triangle_distance", json_of(m.distance)},
            {"triangle_normal_degrees", json_of(m.normal_degrees)},
            {"inverted", m.inverted},
            {"degenerate", m.degenerate},
            {"edge_length_mean", m.edge_mean},
            {"edge_length_spread", m.edge_spread}};
}

void print_table(const Json& j, const std::string& prefix = "") {
    for (const auto& [name, value] : j.items()) {
        if (value.is_object()) print_table(value, prefix + name + " ");
        else if (value.is_number_float()) fmt::print("{:<40}{:.6g}\n", prefix + name, value.get<double>());
        else if (!value.is_array()) fmt::print("{:<40}{}\n", prefix + name, value.is_string() ? value.get<std::string>() : value.dump());
    }
}

int run_mesh(const MeshCommandOptions& o) {
    if (o.scene.empty()) throw UsageError("mesh: expected a scene file");
    if (o.outputs.empty() && !o.stats && o.stats_json.empty())
        throw UsageError("mesh: expected an output file, -o FILE");
    for (const std::string& path : o.outputs)
        if (!mesh_format(path))
            throw UsageError(fmt::format("-o: expected a name that ends in one of {}, got '{}'",
                                         known_mesh_extensions(), path));
    std::vector<std::string> files = o.outputs;
    if (!o.stats_json.empty()) files.push_back(o.stats_json);
    check_distinct(files);
    const MeshSettings method = settings(o);
    const int threads = o.threads.value_or(tbb::info::default_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));

    PhaseClock clock;
    clock.begin("read");
    const Scene scene = load_scene(o);
    for (const std::string& path : files) check_writable(path);
    clock.begin("polygonize");
    const SceneMesh mesh = mesh_scene(scene, method);
    clock.end();
    for (const std::string& warning : mesh.warnings)
        if (!o.quiet) fmt::print(stderr, "deburr: {}\n", warning);
    if (o.verbose && !o.quiet)
        fmt::print(stderr, "deburr: {} triangles, {} vertices in {:.3f} s\n", mesh.mesh.triangles.size(),
                   mesh.mesh.positions.size(), clock.wall("polygonize"));

    clock.begin("write");
    MeshNotes notes{scene.names, {}};
    for (const Material& m : scene.materials) notes.colors.push_back(m.color.a);
    for (const std::string& path : o.outputs)
        write_whole_file(path, encode(mesh.mesh, *mesh_format(path), notes));
    clock.end();

    if (o.stats || !o.stats_json.empty()) {
        clock.begin("measure");
        const MeshMetrics metrics = combined(measure_parts(mesh));
        clock.end();
        Json j;
        j["scene"] = scene.file;
        j["method"] = o.method;
        j["parameters"] = scene.parameters;
        j["mesh"] = json_of(metrics);
        if (method.method == MeshMethod::triage)
            j["triage"] = {{"cells", mesh.triage.cells}, {"open_cells", mesh.triage.open_cells}, {"rounds", mesh.triage.rounds}};
        for (const PhaseTime& t : clock.times()) j["seconds"][t.name] = t.wall;
        if (o.stats) print_table(j);
        if (!o.stats_json.empty())
            write_whole_file(o.stats_json, j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    }
    return 0;
}

}  // namespace

Command add_mesh_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("mesh", "write a scene's solids as a closed mesh");
    const auto options = std::make_shared<MeshCommandOptions>();
    add_scene_options(*command, *options);
    add_output_option(*command, *options, known_mesh_extensions());
    command->add_option("--method", options->method, mesh_method_names() + "; default: triage")->type_name("NAME");
    command->add_option("--tolerance", options->tolerance,
                        "triage: refine until no triangle's middle is farther from the surface")
        ->type_name("D");
    command->add_option("--grid", options->grid, "marching-cubes: side of a cube; default: half the least radius")
        ->type_name("H");
    add_run_options(*command, *options);
    add_statistics_options(*command, *options);
    return {command, [options] { return run_mesh(*options); }};
}

}  // namespace deburr
