// Deburr's rounded pictures against POV-Ray's of the same scenes (deburr export-pov), as whole processes on one thread.
// POV-Ray renders isosurfaces with a proven max_gradient, at the accuracy that the right picture needs and at its
// default accuracy, with the profile clamped by min and max and by cases, which POV-Ray evaluates in half the time; and
// sharp CSG of planes and boxes.
#include <fmt/format.h>

#include "bench/picture.hpp"
#include "bench/program.hpp"
#include "bench/sections.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {
namespace {

constexpr int rounds = 7;
constexpr int rounds_of_hits = 51;  // each takes some 10 ms
constexpr int patch = 4;            // side in pixels of patches whose rays follow each other, as in a picture

// The time in which camera rays find the exact hit on Lobb's obj4 alone, for the rays that meet it.
void primary_hits(Report& report) {
    Scene scene = scene_of("first");
    scene.solids.pop_back();  // removes the ground
    const ImplicitTracer tracer(scene.solids);
    const ProjectiveCamera camera(scene.camera, scene.width, scene.height);
    TraceCounters counters;
    std::vector<Ray> rays;
    for (int y = 0; y < scene.height; y += patch)
        for (int x = 0; x < scene.width; x += patch)
            for (int k = 0; k < patch * patch; ++k) {
                const Ray ray = camera.ray(x + k % patch + 0.5, y + k / patch + 0.5);
                if (tracer.closest_hit(ray, infinity, counters)) rays.push_back(ray);
            }
    std::vector<Hit> hits(rays.size());
    const double together = seconds_of(
        [&] {
            tracer.closest_hits(rays, hits.data(), counters);
            keep(hits);
        },
        rounds_of_hits);
    const double alone = seconds_of(
        [&] {
            for (const Ray& ray : rays) keep(tracer.closest_hit(ray, infinity, counters));
        },
        rounds_of_hits);
    report.figure("obj4: exact primary hits", 1e-6 * double(rays.size()) / together, "million/s", at_least(8));
    report.figure("obj4: exact primary hits, ray by ray", 1e-6 * double(rays.size()) / alone, "million/s");
}

}  // namespace

void deburr_against_povray(Report& report) {
    primary_hits(report);
    report.note("libfive, about 1 million pixels/s of obj4, is not in Debian 12: not run here");
    if (!cpu_seconds_of_program({"povray", "--version"})) {
        report.note("povray is not installed: left out");
        return;
    }
    const Folder folder;
    for (const char* name : {"csg_examples", "variable_rounding"}) {
        const auto ours = [&] {
            return *cpu_seconds_of_program({deburr_program(), "render", scene_path(name), "-q", "--threads", "1",
                                            "--spp", "1", "--size", "600x380", "-o", folder / "ours.png"});
        };
        const auto against = [&](const std::string& what, const std::vector<std::string>& options,
                                 std::optional<Bar> bar) {
            std::vector<std::string> words{deburr_program(), "export-pov", scene_path(name), "-q", "--size",
                                           "600x380",        "-o",         folder / "s.pov"};
            words.insert(words.end(), options.begin(), options.end());
            cpu_seconds_of_program(words);
            const auto theirs = [&] {
                return *cpu_seconds_of_program({"povray", "+I" + (folder / "s.pov"), "+O" + (folder / "theirs.png"),
                                                "+W600", "+H380", "+WT1", "-A", "-D"});
            };
            report.ratio(fmt::format("{}: {}", name, what), ratio_of_times(theirs, ours, rounds), bar);
        };
        // The form in which POV-Ray is faster decides.
        against("isosurface, right picture", {}, at_least(50));
        against("isosurface, right picture, by min and max", {"--min-max"}, std::nullopt);
        against("isosurface, default accuracy", {"--accuracy", "0.001"}, at_least(15));
        against("sharp CSG / our rounded", {"--sharp"}, at_least(2));
    }
}

}  // namespace deburr::bench
