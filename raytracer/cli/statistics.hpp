// Statistics of a run of `deburr render`: times by phase, rays, evaluations; as a table (--stats) and as JSON
// (--stats-json).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"
#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// The time of a phase in seconds: wall-clock, and CPU time of all threads together.
struct PhaseTime {
    std::string name;
    double wall = 0, cpu = 0;
};

/// Measures consecutive phases.
class PhaseClock {
public:
    /// Ends the current phase, if any, and begins a new one.
    void begin(const std::string& name);
    void end();
    const std::vector<PhaseTime>& times() const { return times_; }
    /// Wall-clock seconds of the named phase; 0 if there was none.
    double wall(const std::string& name) const;

private:
    std::vector<PhaseTime> times_;
    double wall_start_ = 0, cpu_start_ = 0;
    bool running_ = false;
};

/// The statistics of one run.
struct RunStatistics {
    std::string scene, via;  // via: how surfaces are found: "implicit" or a meshing method
    std::string accel;       // acceleration structure of implicit rays, as name() gives it; else ""
    int width = 0, height = 0;
    Window window;
    int spp = 1, threads = 1;
    std::uint64_t seed = 0;
    bool complete = true;
    std::int64_t pixels = 0;  // number of rendered pixels
    std::vector<PhaseTime> phases;
    TraceCounters counters;
    std::optional<BspStatistics> bsp;
};

/// The statistics as a table; each line ends with a newline.
std::string statistics_table(const RunStatistics& run);
/// The statistics as a JSON object, followed by a newline.
std::string statistics_json(const RunStatistics& run);

}  // namespace deburr
