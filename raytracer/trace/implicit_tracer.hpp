// Implicit rendering: traces exact rays against CSG of rounded densities, without a mesh, by BSPs of local CSG [Lobb
// §3.5, after Jansen 1986], one for each prototype (instances.hpp).
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

/// Statistics of the BSPs that have been built so far (instances.hpp); only `prototypes` counts all of them.
struct BspStatistics {
    std::size_t cells = 0, empty_cells = 0,
                flat_cells = 0;         // all cells; those without a surface; those with planes only
    std::size_t half_spaces = 0;        // sum over the solids that the BSPs were built from
    std::size_t prototypes = 0;         // number of BSPs, each of a prototype or of a part of one
    std::size_t instances = 0;          // instances in prototypes, and BSPs beyond each prototype's first
    double mean_local_half_spaces = 0;  // mean number of half-spaces in a cell that is not empty
    int depth = 0;                      // of the deepest BSP
};

/// A tracer for a list of solids. Hit::solid is the index in that list. Queries are thread-safe.
class ImplicitTracer final : public RayTracer {
public:
    /// Builds the BSPs. The criterion serves the densities whose roots are searched for. `store`, if not null, provides
    /// BSPs that an earlier scene had in common with this one, and keeps these; it is used during construction only.
    /// Throws TooEntangled if a solid's density is too complex.
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
