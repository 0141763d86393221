#include <algorithm>

#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/trace/instances.hpp"

namespace deburr {

namespace {

// The instances in a prototype. A placed prototype gets the ray with a unit direction in its own coordinates, so that
// tolerances have the same meaning there; its distances along the ray are `rate` times those around.
class PrototypeInstances final : public InstanceTracer {
public:
    PrototypeInstances(const Prototypes& all, const Prototype& prototype) : all_(all), prototype_(prototype) {}

    FoundSurface closest_hit(std::uint32_t number, const Ray& ray, double t_max, double end,
                             TraceCounters& counters) const override;
    bool any_hit(std::uint32_t number, const Ray& ray, double t_max, TraceCounters& counters) const override;
    void closest_hit_packet(std::uint32_t number, const RayPacket& rays, const double* end, Lanes lanes,
                            PacketSurfaces& found, TraceCounters& counters) const override;
    Lanes any_hit_packet(std::uint32_t number, const RayPacket& rays, Lanes lanes,
                         TraceCounters& counters) const override;

private:
    struct Entered;

    const Prototypes& all_;
    const Prototype& prototype_;
};

// An instance that rays enter, with the tracer of its prototype.
struct PrototypeInstances::Entered {
    Entered(const PrototypeInstances& around, std::uint32_t number, std::size_t rays, TraceCounters& counters)
        : p(around.prototype_.instances[number]),
          prototype(around.all_[p.prototype]),
          tracer(prototype.tracer),
          instances(around.all_, prototype) {
        counters.instances += rays;
    }

    const Instance& p;
    const Prototype& prototype;
    const SurfaceTracer& tracer;
    PrototypeInstances instances;
};

// A ray in the coordinates of a placed prototype.
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
    // The distance in the prototype, rounded up, since a distance is rounded there and back: a crossing at `outside`
    // must be found.
    double end(double outside) const { return outside * rate * (1 + 4 * epsilon); }

    Ray ray;
    double rate = 1;
};

// Maps what was found in a placed prototype back to the coordinates around; `ray` is the ray there.
void outside(FoundSurface& found, const Instance& p, const Ray& ray, double rate) {
    if (!(found.crossing.t < infinity)) return;
    found.crossing.t = (found.start + found.crossing.t) / rate;
    found.start = 0;
    if (!p.only_moved)
        found.crossing.normal = glm::normalize(found.crossing.normal * p.into.linear);  // the transpose of `into`
    if (found.crossing.material < 0) found.crossing.material = p.material;
    found.solid = p.solid;
    found.error = found.error * p.stretch + 4 * epsilon * (largest(ray.origin) + found.crossing.t);
}

// The same mapping for ray k of a packet.
void outside(PacketSurfaces& found, int k, const Instance& p, const RayPacket& rays, double rate) {
    found.t[k] = (found.start[k] + found.t[k]) / rate;
    found.start[k] = 0;
    if (!p.only_moved) {
        const Vec3 normal =
            glm::normalize(Vec3(found.normal[0][k], found.normal[1][k], found.normal[2][k]) * p.into.linear);
        for (int axis = 0; axis < 3; ++axis) found.normal[axis][k] = normal[axis];
    }
    if (found.material[k] < 0) found.material[k] = p.material;
    found.solid[k] = p.solid;
    found.error[k] = found.error[k] * p.stretch + 4 * epsilon * (largest(rays.ray(k).origin) + found.t[k]);
}

FoundSurface PrototypeInstances::closest_hit(std::uint32_t number, const Ray& ray, double t_max, double end,
                                             TraceCounters& counters) const {
    const Entered e(*this, number, 1, counters);
    const Inside in(e.p, ray);
    FoundSurface found = e.tracer.closest_hit(in.ray, t_max * in.rate, counters, &e.instances, in.end(end));
    outside(found, e.p, ray, in.rate);
    return found;
}

bool PrototypeInstances::any_hit(std::uint32_t number, const Ray& ray, double t_max, TraceCounters& counters) const {
    const Entered e(*this, number, 1, counters);
    const Inside in(e.p, ray);
    return e.tracer.any_hit(in.ray, t_max * in.rate, counters, &e.instances);
}

void PrototypeInstances::closest_hit_packet(std::uint32_t number, const RayPacket& rays, const double* end, Lanes lanes,
                                            PacketSurfaces& found, TraceCounters& counters) const {
    const Entered e(*this, number, count(lanes), counters);
    RayPacket inside;
    alignas(64) double rate[RayPacket::size];
    packet_functions.map(e.p.into, e.p.only_moved, rays, end, inside, rate);
    e.tracer.closest_hit_packet(inside, lanes, found, counters, &e.instances);
    for_each_lane(found.found, [&](int k) { outside(found, k, e.p, rays, rate[k]); });
}

Lanes PrototypeInstances::any_hit_packet(std::uint32_t number, const RayPacket& rays, Lanes lanes,
                                         TraceCounters& counters) const {
    const Entered e(*this, number, count(lanes), counters);
    RayPacket inside;
    alignas(64) double rate[RayPacket::size];
    packet_functions.map(e.p.into, e.p.only_moved, rays, rays.t_max, inside, rate);
    return e.tracer.any_hit_packet(inside, lanes, counters, &e.instances);
}

}  // namespace

ImplicitTracer::ImplicitTracer(const std::vector<Solid>& solids, Criterion criterion, RootMethod root_method,
                               Accel accel, BspStore* store)
    : prototypes_(new Prototypes(solids, criterion, root_method, accel, store)) {}

ImplicitTracer::~ImplicitTracer() = default;

namespace {

// Far above the error of the position, and far below anything visible.
double offset_of(double error) { return 128 * error; }

Hit hit_of(const FoundSurface& found, const Ray& ray) {
    if (!(found.crossing.t < infinity)) return {};
    Hit hit;
    hit.t = found.crossing.t;
    hit.position = ray.origin + ray.direction * hit.t;
    if (found.start > 0) [[unlikely]] {
        hit.t += found.start;
        // Summed as the search did, so that it is on the surface however far away the ray starts.
        hit.position = (ray.origin + ray.direction * found.start) + ray.direction * found.crossing.t;
    }
    hit.normal = found.crossing.normal;
    hit.solid = found.solid;
    hit.material = std::max(0, found.crossing.material);
    hit.offset = offset_of(found.error);
    return hit;
}

}  // namespace

Hit ImplicitTracer::closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.rays;
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    return hit_of((*prototypes_)[0].tracer.closest_hit(ray, t_max, counters, &instances), ray);
}

bool ImplicitTracer::any_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.shadow_rays;
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    return (*prototypes_)[0].tracer.any_hit(ray, t_max, counters, &instances);
}

namespace {

// Fills a packet with at most RayPacket::size rays, in order; returns their lanes.
Lanes load(RayPacket& packet, std::span<const Ray> rays, const double* t_max) {
    if (rays.size() == RayPacket::size) {
        packet_functions.load(packet, rays.data(), t_max);
    } else {  // pads with copies, so that every lane holds valid numbers
        Ray padded[RayPacket::size];
        double padded_t_max[RayPacket::size];
        for (std::size_t k = 0; k < RayPacket::size; ++k) {
            padded[k] = rays[k < rays.size() ? k : 0];
            padded_t_max[k] = t_max[k < rays.size() ? k : 0];
        }
        packet_functions.load(packet, padded, padded_t_max);
    }
    return (Lanes(1) << rays.size()) - 1;
}

void set_hit(Hit& hit, const Ray& ray, const PacketSurfaces& found, int k) {
    if (!(found.found >> k & 1)) {
        hit = {};
        return;
    }
    // Member by member: a Hit that is assembled and then copied would wait for its parts.
    const double t = found.t[k], start = found.start[k];
    for (int axis = 0; axis < 3; ++axis) {
        const double o = ray.origin[axis], d = ray.direction[axis];
        hit.position[axis] = (start > 0 ? o + d * start : o) + d * t;
        hit.normal[axis] = found.normal[axis][k];
    }
    hit.t = start > 0 ? t + start : t;
    hit.solid = found.solid[k];
    hit.material = std::max(0, found.material[k]);
    hit.offset = offset_of(found.error[k]);
}

}  // namespace

void ImplicitTracer::closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const {
    counters.rays += rays.size();
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    RayPacket packet;
    PacketSurfaces found;
    double endless[RayPacket::size];
    std::fill_n(endless, RayPacket::size, infinity);
    for (std::size_t first = 0; first < rays.size(); first += RayPacket::size) {
        const auto some = rays.subspan(first, std::min(rays.size() - first, std::size_t(RayPacket::size)));
        const Lanes lanes = load(packet, some, endless);
        (*prototypes_)[0].tracer.closest_hit_packet(packet, lanes, found, counters, &instances);
        for (std::size_t k = 0; k < some.size(); ++k) set_hit(hits[first + k], some[k], found, int(k));
    }
}

void ImplicitTracer::any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                              TraceCounters& counters) const {
    counters.shadow_rays += rays.size();
    const PrototypeInstances instances(*prototypes_, (*prototypes_)[0]);
    RayPacket packet;
    for (std::size_t first = 0; first < rays.size(); first += RayPacket::size) {
        const std::size_t count = std::min(rays.size() - first, std::size_t(RayPacket::size));
        const Lanes lanes = load(packet, rays.subspan(first, count), &t_max[first]);
        const Lanes any = (*prototypes_)[0].tracer.any_hit_packet(packet, lanes, counters, &instances);
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
        const CellPrimitives& primitives = prototype.tracer.surfaces().cell_primitives;
        s.instances += prototype.instances.size() + prototype.tracer.trees().size() - 1;
        std::uint32_t first = 0;  // the tree's first cell primitive
        for (const BspTree& tree : prototype.tracer.trees()) {
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
