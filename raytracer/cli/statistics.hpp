// What a run did: times by phase, rays, densities. For people (--stats) and for programs
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

/// Seconds: on the wall, and of all threads together.
struct PhaseTime {
    std::string name;
    double wall = 0, cpu = 0;
};

/// Times one phase after the other.
class PhaseClock {
public:
    /// Ends the phase under way, if any, and begins this one.
    void begin(const std::string& name);
    void end();
    const std::vector<PhaseTime>& times() const { return times_; }
    /// Wall seconds of the named phase; 0 if there was none.
    double wall(const std::string& name) const;

private:
    std::vector<PhaseTime> times_;
    double wall_start_ = 0, cpu_start_ = 0;
    bool running_ = false;
};

struct RunStatistics {
    std::string scene, via;  // the road to the surface: "implicit", …
    std::string accel;       // of implicit rays: "bsp", …; else empty
    int width = 0, height = 0;
    Window window;
    int spp = 1, threads = 1;
    std::uint64_t seed = 0;
    bool complete = true;
    std::int64_t pixels = 0;  // that were rendered
    std::vector<PhaseTime> phases;
    TraceCounters counters;
    std::optional<BspStatistics> bsp;
};

/// A table, each line with its end.
std::string statistics_table(const RunStatistics& run);
/// A JSON object, with a line's end.
std::string statistics_json(const RunStatistics& run);

}  // namespace deburr
