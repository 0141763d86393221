// Implicit rendering: exact rays against primary CSG of rounded densities, through BSPs of local CSG
// [Lobb §3.5, after Jansen 1986], one for each prototype (instances.hpp).
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bounds/root_finder.hpp"
#include "bounds/solid.hpp"
#include "raytracer/trace/ray_tracer.hpp"
#include "raytracer/trace/trace_settings.hpp"

namespace deburr {

class BspStore;
class Prototypes;

/// Figures of the BSPs that have been built so far (instances.hpp); `prototypes` counts all.
struct BspStatistics {
    std::size_t cells = 0, empty_cells = 0, flat_cells = 0;
    std::size_t half_spaces = 0;        // that the cells were made of
    std::size_t prototypes = 0;         // BSPs, each of a prototype or of a part of one
    std::size_t instances = 0;          // of these in others
    double mean_local_half_spaces = 0;  // in the cells that hold a surface
    int depth = 0;
};

class ImplicitTracer final : public RayTracer {
public:
    /// The criterion matters where roots are searched for. Where `store` has BSPs of an earlier scene that this one
    /// has, too, they are not built again.
    explicit ImplicitTracer(const std::vector<Solid>& solids, Criterion criterion = Criterion::exact,
                            RootMethod root_method = RootMethod::where_needed, Accel accel = Accel::bvh,
                            BspStore* store = nullptr);
    ~ImplicitTracer() override;
    Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const override;
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const override;
    void closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const override;
    void any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                  TraceCounters& counters) const override;
    BspStatistics statistics() const;

private:
    std::unique_ptr<const Prototypes> prototypes_;
};

}  // namespace deburr
