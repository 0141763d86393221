#include <algorithm>

#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/trace/instances.hpp"

namespace deburr {

namespace {

// What is placed in a space. It sees the ray with a unit direction of its own, so that tolerances mean
// there what they mean here; distances along it are longer by `rate`.
class PrototypeInstances final : public InstanceTracer {
public:
    PrototypeInstances(const Prototypes& all, const Prototype& prototype) : all_(all), prototype_(prototype) {}

    FoundSurface closest_hit(std::uint32_t number, const Ray& ray, double t_max, double end,
                             TraceCounters& counters) const override;
    bool any_hit(std::uint32_t number, const Ray& ray, double t_max, TraceCounters& counters) const override;
    void closest_hit_packet(std::uint32_t number, const RayBatch& rays, FoundSurface* found,
                            TraceCounters& counters) const override;
    Lanes any_hit_packet(std::uint32_t number, const RayBatch& rays, TraceCounters& counters) const override;

private:
    struct Entered;

    const Prototypes& all_;
    const Prototype& prototype_;
};

// A placement that rays enter.
struct PrototypeInstances::Entered {
    Entered(const PrototypeInstances& around, std::uint32_t number, std::size_t rays, TraceCounters& counters)
        : p(around.prototype_.instances[number]),
          prototype(around.all_[p.prototype]),
          bsp(prototype.bsp),
          instances(around.all_, prototype) {
        counters.instances += rays;
    }

    const Instance& p;
    const Prototype& prototype;
    const SurfaceTracer& bsp;
    PrototypeInstances instances;
};

// What a ray is in the placed space.
struct Inside {
    Inside(const Instance& p, const Ray& from) {
        if (p.only_moved) {
            ray = {from.origin + p.into.shift, from.direction};
            return;
        }
        const Vec3 direction = p.into.linear * from.direction;
        rate = glm::length(direction);
        ray = {p.into(from.origin), direction / rate};
    }
    // A distance is rounded there and back: what is at `end` must be found.
    double end(double outside) const { return outside * rate * (1 + 4 * epsilon); }

    Ray ray;
    double rate = 1;
};

// What several are.
struct InsideBatch {
    InsideBatch(const Instance& p, const RayBatch& from) : count(from.size()) {
        for (std::size_t k = 0; k < count; ++k) {
            const Inside in(p, from.rays[k]);
            rays[k] = in.ray;
            rates[k] = in.rate;
            t_max[k] = from.t_max[k] * in.rate;
            ends[k] = in.end(from.end[k]);
        }
    }
    RayBatch batch() const { return {{rays, count}, {t_max, count}, {ends, count}}; }

    std::size_t count;
    Ray rays[RayPacket::size];
    double rates[RayPacket::size], t_max[RayPacket::size], ends[RayPacket::size];
};

// What was found along `ray`, in the space around again.
FoundSurface outside(FoundSurface found, const Instance& p, const Ray& ray, double rate) {
    if (!(found.crossing.t < infinity)) return {};
    found.crossing.t = (found.start + found.crossing.t) / rate;
    found.start = 0;
    if (!p.only_moved)
        found.crossing.normal = glm::normalize(found.crossing.normal * p.into.linear);  // by the transpose
    if (found.crossing.material < 0) found.crossing.material = p.material;
    found.solid = p.solid;
    found.error = found.error * p.stretch + 4 * epsilon * (largest(ray.origin) + found.crossing.t);
    return found;
}

FoundSurface PrototypeInstances::closest_hit(std::uint32_t number, const Ray& ray, double t_max, double end,
                                             TraceCounters& counters) const {
    const Entered e(*this, number, 1, counters);
    const Inside in(e.p, ray);
    return outside(e.bsp.closest_hit(in.ray, t_max * in.rate, counters, &e.instances, in.end(end)), e.p, ray, in.rate);
}

bool PrototypeInstances::any_hit(std::uint32_t number, const Ray& ray, double t_max, TraceCounters& counters) const {
    const Entered e(*this, number, 1, counters);
    const Inside in(e.p, ray);
    return e.bsp.any_hit(in.ray, t_max * in.rate, counters, &e.instances);
}

void PrototypeInstances::closest_hit_packet(std::uint32_t number, const RayBatch& rays, FoundSurface* found,
                                            TraceCounters& counters) const {
    const Entered e(*this, number, rays.size(), counters);
    const InsideBatch in(e.p, rays);
    e.bsp.closest_hit_packet(in.batch(), found, counters, &e.instances);
    for (std::size_t k = 0; k < rays.size(); ++k) found[k] = outside(found[k], e.p, rays.rays[k], in.rates[k]);
}

Lanes PrototypeInstances::any_hit_packet(std::uint32_t number, const RayBatch& rays, TraceCounters& counters) const {
    const Entered e(*this, number, rays.size(), counters);
    return e.bsp.any_hit_packet(InsideBatch(e.p, rays).batch(), counters, &e.instances);
}

}  // namespace

ImplicitTracer::ImplicitTracer(const std::vector<Solid>& solids, Criterion criterion, RootMethod root_method,
                               Accel accel)
    : prototypes_(new Prototypes(solids, criterion, root_method, accel)) {}

ImplicitTracer::~ImplicitTracer() = default;

namespace {

Hit hit_of(const FoundSurface& found, const Ray& ray) {
    if (!(found.crossing.t < infinity)) return {};
    Hit hit;
    hit.t = found.crossing.t;
    hit.position = ray.origin + ray.direction * hit.t;
    if (found.start > 0) [[unlikely]] {
        hit.t += found.start;
        // Summed up as the search did: on the surface, wherever the ray comes from.
        hit.position = (ray.origin + ray.direction * found.start) + ray.direction * found.crossing.t;
    }
    hit.normal = found.crossing.normal;
    hit.solid = found.solid;
    hit.material = std::max(0, found.crossing.material);
    // Far beyond the error of the position, far below anything to be seen.
    hit.offset = 128 * found.error;
    return hit;
}

}  // namespace

Hit ImplicitTracer::closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.rays;
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    return hit_of((*prototypes_)[0].bsp.closest_hit(ray, t_max, counters, &instances), ray);
}

bool ImplicitTracer::any_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.shadow_rays;
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    return (*prototypes_)[0].bsp.any_hit(ray, t_max, counters, &instances);
}

void ImplicitTracer::closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const {
    static const std::vector<double> endless(RayPacket::size, infinity);
    counters.rays += rays.size();
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    FoundSurface found[RayPacket::size];
    for (std::size_t first = 0; first < rays.size(); first += RayPacket::size) {
        const auto packet = rays.subspan(first, std::min(rays.size() - first, std::size_t(RayPacket::size)));
        (*prototypes_)[0].bsp.closest_hit_packet({packet, endless, endless}, found, counters, &instances);
        for (std::size_t k = 0; k < packet.size(); ++k) hits[first + k] = hit_of(found[k], packet[k]);
    }
}

void ImplicitTracer::any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                              TraceCounters& counters) const {
    counters.shadow_rays += rays.size();
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    for (std::size_t first = 0; first < rays.size(); first += RayPacket::size) {
        const std::size_t count = std::min(rays.size() - first, std::size_t(RayPacket::size));
        const auto ends = t_max.subspan(first, count);
        const Lanes any =
            (*prototypes_)[0].bsp.any_hit_packet({rays.subspan(first, count), ends, ends}, counters, &instances);
        for (std::size_t k = 0; k < count; ++k) occluded[first + k] = any >> k & 1;
    }
}

BspStatistics ImplicitTracer::statistics() const {
    BspStatistics s;
    std::size_t local = 0;
    for (std::size_t i = 0; i < prototypes_->size(); ++i) {
        if (!prototypes_->built(i)) {
            ++s.prototypes;
            continue;
        }
        const Prototype& prototype = *prototypes_->built(i);
        const CellPrimitives& primitives = prototype.bsp.surfaces().cell_primitives;
        s.instances += prototype.instances.size() + prototype.bsp.trees().size() - 1;
        std::uint32_t first = 0;  // primitive of the tree
        for (const BspTree& tree : prototype.bsp.trees()) {
            ++s.prototypes;
            s.cells += tree.cells.size();
            s.half_spaces += tree.half_spaces;
            s.depth = std::max(s.depth, tree.depth);
            for (const BspCell& cell : tree.cells) {
                bool flat = cell.count > 0;
                for (std::uint32_t p = first + cell.first; p < first + cell.first + cell.count; ++p) {
                    local += primitives.half_spaces(p);
                    flat &= primitives[p].kind == CellPrimitive::Kind::plane;
                }
                s.empty_cells += cell.count == 0;
                s.flat_cells += flat;
            }
            if (!tree.cells.empty()) first += tree.cells.back().first + tree.cells.back().count;
        }
    }
    if (s.cells > s.empty_cells) s.mean_local_half_spaces = double(local) / double(s.cells - s.empty_cells);
    return s;
}

}  // namespace deburr
