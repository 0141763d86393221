// The exact surface against its triage mesh in Embree: the same rays, traced by both in packets of 16 where a picture
// traces them together, and singly elsewhere.
#include <fmt/format.h>

#include "bench/embree_rays.hpp"
#include "bench/picture.hpp"
#include "bench/program.hpp"
#include "bench/sections.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {
namespace {

// The rays of a picture with one sample, in packets and singly.
void compare_rays(Report& report, const char* name, const Scene& scene, const ImplicitTracer& implicit,
                  const EmbreeMesh& embree, double packets_bar) {
    TraceCounters counters;
    const Recording recording(implicit);
    render_picture(scene, recording, counters);
    const EmbreeRays together(recording, false), alone(recording, true);
    const Ratio packets = ratio_of([&] { recording.ask(implicit, counters); }, [&] { together.ask(embree); }, 9);
    const double rays = 1e-6 * double(recording.rays().size());
    report.ratio(fmt::format("{}: packets of 16", name), packets, at_most(packets_bar));
    report.figure(fmt::format("{}: exact rays in packets", name), rays / packets.a, "million/s");
    report.figure(fmt::format("{}: Embree's rays in packets", name), rays / packets.b, "million/s");
    const Ratio single = ratio_of([&] { recording.ask_alone(implicit, counters); }, [&] { alone.ask(embree); }, 5);
    report.ratio(fmt::format("{}: single rays", name), single, at_most(1.1));
    report.figure(fmt::format("{}: exact single rays", name), rays / single.a, "million/s");
}

// The rays of paths: a picture with 16 samples, whose bounces go in all directions.
void compare_paths(Report& report, const char* name, Scene scene, const ImplicitTracer& implicit,
                   const EmbreeMesh& embree) {
    scene.width /= 2;  // so that as many samples take as long
    scene.height /= 2;
    TraceCounters counters;
    const Recording recording(implicit);
    render_picture(scene, recording, counters, 16);
    const EmbreeRays rays(recording, false);
    report.ratio(fmt::format("{}, spp 16: rays of paths", name),
                 ratio_of([&] { recording.ask(implicit, counters); }, [&] { rays.ask(embree); }, 3), at_most(1.3));
}

}  // namespace

void implicit_against_embree(Report& report) {
    for (const char* name : {"csg_examples", "variable_rounding", "staplers"}) {
        const Scene scene = scene_of(name);
        const ImplicitTracer implicit(scene.solids);
        SceneMesh mesh = mesh_scene(scene, picture_mesh_settings());
        report.figure(fmt::format("{}: triangles", name), double(mesh.mesh.triangles.size()), "");
        {
            const EmbreeMesh embree(mesh.mesh);
            compare_rays(report, name, scene, implicit, embree, name == std::string("csg_examples") ? 1.2 : 1.5);
            compare_paths(report, name, scene, implicit, embree);
        }
        const MeshTracer tracer(std::move(mesh.mesh), mesh.near);
        TraceCounters counters;
        report.ratio(fmt::format("{}: a picture, the mesh by single rays", name),
                     ratio_of([&] { render_picture(scene, implicit, counters); },
                              [&] { render_picture(scene, tracer, counters); }),
                     at_most(1.0));
        const Folder folder;
        const auto whole = [&](const char* via) {
            return *cpu_seconds_of_program({deburr_program(), "render", scene_path(name), "-q", "--threads", "1",
                                            "--spp", "1", "--via", via, "-o", folder / "picture.png"});
        };
        report.ratio(fmt::format("{}: whole process", name),
                     ratio_of_times([&] { return whole("implicit"); }, [&] { return whole("triage"); }, 5));
    }
}

}  // namespace deburr::bench
