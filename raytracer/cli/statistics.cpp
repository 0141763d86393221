#include "raytracer/cli/statistics.hpp"

#include <fmt/format.h>
#include <time.h>

#include <nlohmann/json.hpp>

namespace deburr {
namespace {

double seconds(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::string row(const std::string& name, const std::string& value) {
    return fmt::format("{:<24}{:>16}\n", name, value);
}

std::string row(const std::string& name, std::uint64_t value) { return row(name, fmt::format("{}", value)); }

}  // namespace

void PhaseClock::begin(const std::string& name) {
    end();
    times_.push_back({name, 0, 0});
    wall_start_ = seconds(CLOCK_MONOTONIC);
    cpu_start_ = seconds(CLOCK_PROCESS_CPUTIME_ID);
    running_ = true;
}

void PhaseClock::end() {
    if (!running_) return;
    times_.back().wall = seconds(CLOCK_MONOTONIC) - wall_start_;
    times_.back().cpu = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_;
    running_ = false;
}

double PhaseClock::wall(const std::string& name) const {
    for (const PhaseTime& phase : times_)
        if (phase.name == name) return phase.wall;
    return 0;
}

std::string statistics_table(const RunStatistics& run) {
    std::string text;
    text += row("picture", fmt::format("{}x{}", run.width, run.height));
    const Window& w = run.window;
    if (w != Window{0, 0, run.width, run.height})
        text += row("crop", fmt::format("{}x{}+{}+{}", w.width, w.height, w.x, w.y));
    text += row("samples per pixel", std::uint64_t(run.spp));
    text += row("threads", std::uint64_t(run.threads));
    text += row("seed", run.seed);
    if (!run.complete) text += row("incomplete, pixels done", std::uint64_t(run.pixels));
    for (const PhaseTime& phase : run.phases)
        text += row("time: " + phase.name, fmt::format("{:.3f} s", phase.wall)) +
                row("  of all threads", fmt::format("{:.3f} s", phase.cpu));
    const TraceCounters& c = run.counters;
    text += row("rays", c.rays) + row("shadow rays", c.shadow_rays) + row("instances visited", c.instances) +
            row("cells visited", c.cells) + row("flat hits", c.flat_hits) + row("segments", c.segments) +
            row("splits", c.splits) + row("density evaluations", c.evaluations);
    if (c.rays > 0)
        text += row("  per ray", fmt::format("{:.2f}", double(c.evaluations) / double(c.rays + c.shadow_rays)));
    if (!run.accel.empty()) text += row("accel", run.accel);
    if (run.bsp) {
        text += row("prototypes", run.bsp->prototypes) + row("  instances", run.bsp->instances) +
                row("BSP cells", run.bsp->cells) + row("  empty", run.bsp->empty_cells) +
                row("  flat", run.bsp->flat_cells) + row("  depth", std::uint64_t(run.bsp->depth)) +
                row("half-spaces", run.bsp->half_spaces) +
                row("  per surface cell", fmt::format("{:.2f}", run.bsp->mean_local_half_spaces));
    }
    return text;
}

std::string statistics_json(const RunStatistics& run) {
    nlohmann::ordered_json j;
    j["program"] = "deburr";
    j["version"] = DEBURR_VERSION;
    j["scene"] = run.scene;
    j["via"] = run.via;
    if (!run.accel.empty()) j["accel"] = run.accel;
    j["complete"] = run.complete;
    j["width"] = run.width;
    j["height"] = run.height;
    j["crop"] = {{"x", run.window.x}, {"y", run.window.y}, {"width", run.window.width}, {"height", run.window.height}};
    j["pixels"] = run.pixels;
    j["spp"] = run.spp;
    j["threads"] = run.threads;
    j["seed"] = run.seed;
    j["seconds"] = nlohmann::ordered_json::object();
    for (const PhaseTime& phase : run.phases) j["seconds"][phase.name] = {{"wall", phase.wall}, {"cpu", phase.cpu}};
    const TraceCounters& c = run.counters;
    j["rays"] = c.rays;
    j["shadow_rays"] = c.shadow_rays;
    j["instances_visited"] = c.instances;
    j["cells_visited"] = c.cells;
    j["flat_hits"] = c.flat_hits;
    j["segments"] = c.segments;
    j["splits"] = c.splits;
    j["density_evaluations"] = c.evaluations;
    if (run.bsp)
        j["bsp"] = {{"prototypes", run.bsp->prototypes},
                    {"instances", run.bsp->instances},
                    {"cells", run.bsp->cells},
                    {"empty_cells", run.bsp->empty_cells},
                    {"flat_cells", run.bsp->flat_cells},
                    {"depth", run.bsp->depth},
                    {"half_spaces", run.bsp->half_spaces},
                    {"mean_local_half_spaces", run.bsp->mean_local_half_spaces}};
    // Names that are not UTF-8 are replaced instead of losing the statistics.
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace deburr
