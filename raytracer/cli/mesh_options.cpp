#include "raytracer/cli/mesh_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "raytracer/cli/commands.hpp"
#include "raytracer/model/model_format.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {

CLI::App* add_mesh_options(CLI::App& program, const std::shared_ptr<MeshCommandOptions>& options) {
    CLI::App* command = add_command(program, "mesh", "write a scene's solids as a closed mesh");
    add_scene_options(*command, *options);
    add_output_option(*command, *options, known_mesh_extensions(),
                      "; %n in its name: one for each solid, by its name or number");
    command->add_option("--only", options->only, "this solid, by its name or number; repeatable")
        ->type_name("NAME|ID")
        ->allow_extra_args(false);
    command
        ->add_option("--method", options->method,
                     mesh_method_names() + "; default: triage, and octree for solids with free forms")
        ->type_name("NAME");
    command
        ->add_option(
            "--tolerance", options->tolerance,
            "triage, octree: refine until no point of the mesh is farther from the surface, or inf; triage's default: "
            "0.05 of each solid's least radius")
        ->type_name("D");
    command->add_option("--grid", options->grid, "marching-cubes: side of a cube; default: half the least radius")
        ->type_name("H");
    command->add_option("--edge", options->edge, "octree: side of a cell, nearly the mean length of edges")
        ->type_name("L");
    command->add_option("--level", options->level, "octree: 2^N cells along each solid's longest side")->type_name("N");
    command
        ->add_option("--hard-edges", options->hard_angle,
                     "octree: degrees between faces from which their edge is kept; default: 15")
        ->type_name("A");
    command->add_option("--faces", options->faces, "at most this number of triangles, and as near to it as may be")
        ->type_name("N");
    command
        ->add_option("--unit", options->unit,
                     ".3mf: what the scene's lengths are: " + known_units() + "; default: millimeter")
        ->type_name("NAME");
    command
        ->add_option("--up", options->up,
                     "the axis that is up in the files, but for .glb, which is y-up; default: the scene's")
        ->type_name("y|z");
    command->add_flag("--recentre", options->recenter, "move the middle of the solids to the origin");
    command->add_flag("--no-check", options->no_check, "do not check the mesh against the solids");
    command->add_flag("--force", options->force, "write the mesh even if the check fails");
    add_run_options(*command, *options);
    add_statistics_options(*command, *options);
    return command;
}

MeshSettings mesh_settings(const MeshCommandOptions& o) {
    MeshSettings s;
    if (!o.method.empty()) s.method = parse_mesh_method("--method", o.method);
    if (!o.tolerance.empty())
        s.tolerance = parse_tolerance(o.tolerance);
    else
        s.triage_tolerance_in_radii = default_tolerance_in_radii;
    if (!o.grid.empty()) s.grid = parse_positive("--grid", o.grid);
    if (!o.edge.empty()) s.edge = parse_positive("--edge", o.edge);
    if (!o.level.empty()) s.level = int(parse_whole("--level", o.level, 1, 12));
    if (!o.hard_angle.empty()) {
        s.hard_angle = parse_positive("--hard-edges", o.hard_angle);
        if (s.hard_angle > 180)
            throw UsageError(fmt::format("--hard-edges: expected degrees up to 180, got '{}'", o.hard_angle));
    }
    if (!o.edge.empty() && !o.level.empty())
        throw UsageError("--edge: expected it without --level, which says the same");
    const auto only = [&](const char* option, const std::string& given, MeshMethod method) {
        if (!given.empty() && s.method != method)
            throw UsageError(
                fmt::format("{}: expected --method {}, got '{}'", option, mesh_method_name(method), o.method));
    };
    if (!o.tolerance.empty() && s.method == MeshMethod::marching_cubes)
        throw UsageError("--tolerance: expected --method triage or octree, got 'marching-cubes'");
    s.check = !o.no_check;
    only("--grid", o.grid, MeshMethod::marching_cubes);
    only("--edge", o.edge, MeshMethod::octree);
    only("--level", o.level, MeshMethod::octree);
    only("--hard-edges", o.hard_angle, MeshMethod::octree);
    return s;
}

LengthUnit length_unit(const MeshCommandOptions& o) {
    if (o.unit.empty()) return LengthUnit::millimeter;
    const auto unit = find_unit(o.unit);
    if (!unit) throw UsageError(fmt::format("--unit: expected one of {}, got '{}'", known_units(), o.unit));
    if (std::none_of(o.outputs.begin(), o.outputs.end(),
                     [](const std::string& path) { return mesh_format(path) == MeshFormat::three_mf; }))
        throw UsageError("--unit: expected an output that ends in .3mf, for the other formats have no units");
    return *unit;
}

std::size_t max_faces(const MeshCommandOptions& o) {
    return o.faces.empty() ? 0 : std::size_t(parse_whole("--faces", o.faces, 4, 100'000'000));
}

}  // namespace deburr
