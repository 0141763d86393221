// The exact surface against its triage mesh in Embree: single rays, same camera, same shading.
#include <fmt/format.h>

#include "bench/picture.hpp"
#include "bench/program.hpp"
#include "bench/sections.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {

void implicit_against_embree(Report& report) {
    for (const char* name : {"csg_examples", "variable_rounding"}) {
        Scene scene = scene_of(name);
        const ImplicitTracer implicit(scene.solids);
        SceneMesh mesh = mesh_scene(scene, picture_mesh_settings());
        const std::size_t triangles = mesh.mesh.triangles.size();
        const MeshTracer embree(std::move(mesh.mesh), mesh.near);
        for (const int spp : {1, 16}) {
            if (spp > 1) {  // as many samples take as long on a smaller picture
                scene.width /= 2;
                scene.height /= 2;
            }
            TraceCounters counters;
            const Recording recording(implicit);
            render_picture(scene, recording, counters, spp);
            const Ratio rays =
                ratio_of([&] { recording.ask(implicit, counters); }, [&] { recording.ask(embree, counters); });
            report.ratio(fmt::format("{}, spp {}: rays alone", name, spp), rays, at_most(2.0));
            report.ratio(fmt::format("{}, spp {}: picture with shading", name, spp),
                         ratio_of([&] { render_picture(scene, implicit, counters, spp); },
                                  [&] { render_picture(scene, embree, counters, spp); }, spp == 1 ? 5 : 3),
                         at_most(2.0));
            if (spp > 1) continue;
            report.figure(fmt::format("{}: exact rays", name), 1e-6 * double(recording.rays()) / rays.a, "million/s");
            report.figure(fmt::format("{}: triangles", name), double(triangles), "");
        }
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
