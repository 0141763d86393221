// `deburr mesh SCENE -o FILE …`: writes the solids as a closed mesh.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>

#include "bounds/bounding_box.hpp"
#include "polygonizer/mesh/single_precision.hpp"
#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/farm_options.hpp"
#include "raytracer/cli/mesh_options.hpp"
#include "raytracer/cli/mesh_outputs.hpp"
#include "raytracer/cli/mesh_statistics.hpp"
#include "raytracer/cli/solid_choice.hpp"
#include "raytracer/image/scene_pictures.hpp"
#include "raytracer/mesh/face_count.hpp"
#include "raytracer/model/model_format.hpp"
#include "raytracer/scene/vanished_parts.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/message.hpp"
#include "raytracer/util/progress.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

// The material in glTF's terms.
SurfaceNotes surface_notes(const Material& m) {
    SurfaceNotes s{.ior = m.ior, .emission = m.emission};
    switch (m.kind) {
        case Material::Kind::matte: s.ior = 1.5; break;
        case Material::Kind::plastic: s.roughness = m.roughness; break;
        case Material::Kind::metal: s.metallic = 1, s.roughness = m.roughness; break;
        case Material::Kind::mirror: s.metallic = 1, s.roughness = 0; break;
        case Material::Kind::glass: s.transmission = 1, s.roughness = m.roughness; break;
        case Material::Kind::pbr:
            s = {m.metallic, m.roughness, m.ior, m.transmission, m.clearcoat, m.clearcoat_roughness, m.emission};
            break;
    }
    return s;
}

// A line for each kind of fault in each solid.
std::vector<std::string> failures(const Scene& scene, const std::vector<MeshCheck>& checks) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < checks.size(); ++i) {
        const auto say = [&](const MeshFault& f, const char* one, const char* many) {
            if (f.count == 0) return;
            const std::string line = scene.place(f.line);
            lines.push_back(fmt::format("{}: solid {}: {} {}, {} ({:.6g}, {:.6g}, {:.6g})", line, i + 1, f.count,
                                        f.count == 1 ? one : many, f.count == 1 ? "at" : "the first at", f.location.x,
                                        f.location.y, f.location.z));
        };
        const MeshCheck& c = checks[i];
        say(c.open, "edge of the mesh is open", "edges of the mesh are open");
        say(c.inward, "facet faces inward", "facets face inward");
        say(c.crossing, "pair of facets crosses", "pairs of facets cross");
        say(c.missing, "point of the solid is not in the mesh", "points of the solid are not in the mesh");
        say(c.added, "point of the mesh is not in the solid", "points of the mesh are not in the solid");
    }
    return lines;
}

// Reports the faults that the checks found; false if nothing is to be written.
bool passes(const MeshCommandOptions& o, const Scene& scene, const SceneMesh& mesh) {
    const std::vector<std::string> lines = failures(scene, mesh.checks);
    if (lines.empty() || (o.force && o.quiet)) return true;
    for (const std::string& line : lines) fmt::print(stderr, "deburr: {}\n", line);
    fmt::print(
        stderr, "deburr: the mesh is wrong{}\n",
        o.force ? "" : ", and is not written; a smaller --tolerance or another --method may help, --force writes it");
    return o.force;
}

// Moves the middle of the finite solids (of these, or all) to the origin; returns the translation.
Vec3 recenter(Scene& scene, const std::vector<std::size_t>& only) {
    Box all;
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        if (!only.empty() && !std::binary_search(only.begin(), only.end(), i)) continue;
        if (const Box box = bounding_box(flatten(scene.solids[i])); !box.empty() && box.finite()) all = hull(all, box);
    }
    if (all.empty()) return Vec3(0.0);
    Affine move;
    move.shift = -0.5 * (all.lo + all.hi);
    for (Solid& solid : scene.solids) solid = solid.transformed(move);
    return move.shift;
}

// Warns if files in single precision lose visible detail.
void warn_of_single_precision(const MeshCommandOptions& o, const SceneMesh& mesh) {
    const SinglePrecisionLoss loss = single_precision_loss(mesh.mesh);
    double radius = infinity;
    for (const SolidTree& tree : mesh.trees)
        if (const double r = tree.min_radius(); r > 0) radius = std::min(radius, r);
    constexpr double visible = 0.02;  // in radii
    if (loss.spoiled == 0 && loss.step <= visible * radius) return;
    for (const std::string& path : o.outputs) {
        const MeshFormat format = *mesh_format(path);
        if (format != MeshFormat::stl && format != MeshFormat::glb) continue;
        fmt::print(
            stderr,
            "deburr: {}: single precision has steps of {:.2g} at coordinates up to {:.6g}, and the mesh edges of "
            "{:.2g}: {} facets are flattened or turned over; PLY, OBJ and 3MF hold them, --recentre may help\n",
            path, loss.step, loss.coordinate, loss.min_edge, loss.spoiled);
    }
}

// Loads the scene; a model's file is written in the orientation in which it was read.
Scene load_to_mesh(const MeshCommandOptions& o) {
    Options load = o;
    load.model_only = true;
    if (is_model_path(o.scene) && !o.up.empty()) load.model.z_up = o.up == "z";
    return load_scene(load);
}

// Checks that the files can be written, as far as possible in advance, and loads the textures that they need.
void prepare_files(const MeshCommandOptions& o, Scene& scene, std::vector<std::string> files) {
    std::vector<std::string> inputs = scene.model_files;
    inputs.push_back(o.scene);
    check_outputs(files, {o.stats_json}, inputs);
    // All formats but STL store colours.
    if (std::any_of(files.begin(), files.end(), [](const std::string& path) { return !path.ends_with(".stl"); }))
        load_textures(scene);
    if (!o.stats_json.empty()) files.push_back(o.stats_json);
    for (const std::string& path : files) check_writable(path);
}

// Makes the mesh, with a progress bar unless it takes no noticeable time. `faces` > 0 limits the number of triangles.
SceneMesh mesh_of(const MeshCommandOptions& o, const Scene& scene, const MeshSettings& method, std::size_t faces,
                  PhaseClock& clock) {
    clock.begin("polygonize");
    // With --faces the number of meshes to be made is unknown.
    Progress progress(1, Progress::standard_error(o.quiet || faces));
    SceneMesh mesh;
    try {
        mesh = faces ? mesh_scene_with_faces(scene, method, faces)
                     : mesh_scene(scene, method, {nullptr, [&](double share) { progress.advance(share); }});
    } catch (...) {
        progress.stop();
        throw;
    }
    clock.end();
    constexpr double worth_a_line = 1;  // seconds
    if (clock.wall("polygonize") < worth_a_line)
        progress.stop();
    else
        progress.finish();
    return mesh;
}

void say_what_was_made(const MeshCommandOptions& o, const Scene& scene, const SceneMesh& mesh, double seconds) {
    if (o.quiet) return;
    for (const std::vector<std::string>& lines : {vanished_parts(scene).rounded_away, mesh.warnings})
        for (const std::string& line : lines) message(line);
    if (o.verbose && !mesh.mesh.triangles.empty())
        fmt::print(stderr, "deburr: {} triangles, {} vertices in {:.3f} s\n", mesh.mesh.triangles.size(),
                   mesh.mesh.positions.size(), seconds);
}

MeshNotes notes_of(const MeshCommandOptions& o, const Scene& scene) {
    MeshNotes notes;
    notes.unit = length_unit(o);
    notes.names = scene.names;
    for (const Material& m : scene.materials) {
        notes.colors.push_back(m.color.a);
        notes.surfaces.push_back(surface_notes(m));
    }
    return notes;
}

int run_mesh(const MeshCommandOptions& o) {
    if (o.scene.empty()) throw UsageError("mesh: expected a scene file");
    if (o.outputs.empty() && !o.stats && o.stats_json.empty())
        throw UsageError("mesh: expected an output file, -o FILE");
    check_mesh_names(o.outputs);
    MeshSettings method = mesh_settings(o);
    length_unit(o);  // checks these options before the work
    parse_up(o.up, false);
    const std::size_t faces = max_faces(o);
    const int threads = o.threads.value_or(default_threads());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));

    PhaseClock clock;
    clock.begin("read");
    Scene scene = load_to_mesh(o);
    method.only = chosen_solids(scene, o.only);
    method.leave_out_unbounded = o.only.empty();
    const std::vector<MeshOutput> outputs = mesh_outputs(o.outputs, scene, method.only);
    prepare_files(o, scene, files_of(outputs));
    if (o.recenter)
        if (const Vec3 shift = recenter(scene, method.only); shift != Vec3(0.0) && !o.quiet)
            fmt::print(stderr, "deburr: --recentre: moved by ({:.17g}, {:.17g}, {:.17g})\n", shift.x, shift.y, shift.z);
    const SceneMesh mesh = mesh_of(o, scene, method, faces, clock);
    say_what_was_made(o, scene, mesh, clock.wall("polygonize"));
    if (mesh.mesh.triangles.empty()) throw WorkError(scene.file + ": the mesh is empty, and is not written");

    const bool written = passes(o, scene, mesh);
    if (written && !o.quiet) warn_of_single_precision(o, mesh);
    clock.begin("write");
    const MeshNotes notes = notes_of(o, scene);
    for (const MeshOutput& output : outputs)
        if (written) write_mesh(output, mesh, notes, scene.z_up, parse_up(o.up, scene.z_up));
    clock.end();
    report_statistics(o, scene, mesh, clock);
    return written ? 0 : 1;
}

}  // namespace

Command add_mesh_command(CLI::App& program) {
    const auto options = std::make_shared<MeshCommandOptions>();
    CLI::App* command = add_mesh_options(program, options);
    return {command, [options] { return run_mesh(*options); }};
}

}  // namespace deburr
