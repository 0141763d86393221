// The cost of rounding [Lobb table 1: 1.2 to 5.3 times] and of round parts instead of prisms, and what the exact
// criterion saves.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "bench/picture.hpp"
#include "bench/sections.hpp"
#include "bench/sharpened.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {
namespace {

// The scenes of figures 12 and 13, and the staplers if they exist.
std::vector<std::string> scenes() {
    std::vector<std::string> names{"csg_examples", "variable_rounding"};
    for (const auto& entry : std::filesystem::directory_iterator(DEBURR_SOURCE_DIR "/scenes"))
        if (const std::string name = entry.path().stem();
            entry.path().extension() == ".lua" && name.find("stapler") != std::string::npos)
            names.push_back(name);
    std::sort(names.begin() + 2, names.end());
    return names;
}

// A bored block with four pins, round or with many sides, in pictures with one sample.
void compare_round_parts(Report& report) {
    const auto picture = [](const char* sides) {
        return read_scene(DEBURR_SOURCE_DIR "/bench/scenes/pins.lua", {{"sides", sides}});
    };
    const Scene round = picture("0"), square = picture("4"), many = picture("40");
    const ImplicitTracer of_round(round.solids), of_square(square.solids), of_many(many.solids);
    TraceCounters counters;
    const auto draw = [&](const Scene& scene, const ImplicitTracer& tracer) {
        return [&] { render_picture(scene, tracer, counters); };
    };
    report.ratio("a block with round pins / with square ones", ratio_of(draw(round, of_round), draw(square, of_square)),
                 at_most(1.3));
    report.ratio("a block with round pins / with pins of 40 sides",
                 ratio_of(draw(round, of_round), draw(many, of_many), 3), at_most(0.2));
}

}  // namespace

void rounded_against_sharp(Report& report) {
    for (const std::string& name : scenes()) {
        const Scene rounded = scene_of(name);
        Scene sharp = rounded;
        for (Solid& solid : sharp.solids) solid = sharpened(solid);
        const ImplicitTracer of_rounded(rounded.solids), of_sharp(sharp.solids);
        TraceCounters counters;
        report.ratio(fmt::format("{}: rounded / sharp", name),
                     ratio_of([&] { render_picture(rounded, of_rounded, counters); },
                              [&] { render_picture(sharp, of_sharp, counters); }),
                     at_most(1.25));
    }
    compare_round_parts(report);
    const Scene scene = scene_of("variable_rounding");
    const ImplicitTracer exact(scene.solids, Criterion::exact, RootMethod::always),
        printed(scene.solids, Criterion::lobb, RootMethod::always);
    TraceCounters of_exact, of_printed;
    render_picture(scene, exact, of_exact);
    render_picture(scene, printed, of_printed);
    report.figure("variable_rounding: segments, exact / eq. 6", double(of_exact.segments) / double(of_printed.segments),
                  "counted");
}

}  // namespace deburr::bench
